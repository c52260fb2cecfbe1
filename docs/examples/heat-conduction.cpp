/// Heat conduction in a square plate, −∇·(κ∇T) = q, by FETI-DP through Stratimikos:
///     example-heat-conduction LIST.xml [ELEMENTS SUBDOMAINS]
/// The left side is kept at T = 20, the right one at 0, the others are insulated. Two bars conduct a thousand
/// times as well as the rest. The mesh, n × n Q1 elements cut into m × m subdomains, is the program's own.
/// Once the matrix is factorised two sources of heat are solved for, one after the other.

#include "epafi/adapters/Stratimikos.hpp"
#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/decomposition/ElementMatrices.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <array>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

using namespace epafi;
using namespace epafi::decomposition;

namespace {

/// n × n elements; node (i, j) is i + j(n + 1), and so is its unknown.
struct Plate {
  int elements, subdomains;

  [[nodiscard]] GlobalOrdinal node(int i, int j) const {
    return i + j * (static_cast<GlobalOrdinal>(elements) + 1);
  }
  /// κ of the element with lower left node (i, j).
  [[nodiscard]] double conductivity(int i, int j) const {
    const double x = (i + 0.5) / elements, y = (j + 0.5) / elements;
    const bool isBar = x > 0.1 && x < 0.9 && ((y > 0.25 && y < 0.3) || (y > 0.7 && y < 0.75));
    return isBar ? 1000 : 1;
  }
  /// The first of the elements of the k-th subdomain in a row, or in a column.
  [[nodiscard]] int first(int k) const { return k * elements / subdomains; }
};

/// Streams in the elements of a subdomain, the s-th in a row and t-th in a column.
void addElements(const Plate& plate, int s, int t, ElementMatrices& matrices) {
  const double h = 1.0 / plate.elements;
  const Eigen::Matrix4d unit{{4, -1, -2, -1}, {-1, 4, -1, -2}, {-2, -1, 4, -1}, {-1, -2, -1, 4}}; // of −6Δ
  for (int j = plate.first(t); j < plate.first(t + 1); ++j)
    for (int i = plate.first(s); i < plate.first(s + 1); ++i) {
      const std::array nodes{plate.node(i, j), plate.node(i + 1, j), plate.node(i + 1, j + 1),
                             plate.node(i, j + 1)};
      const Eigen::MatrixXd places =
          h * Eigen::MatrixXd{{1.0 * i, 1.0 * j}, {i + 1.0, 1.0 * j}, {i + 1.0, j + 1.0}, {1.0 * i, j + 1.0}};
      const Eigen::MatrixXd stiffness = plate.conductivity(i, j) / 6 * unit;
      matrices.add(s + t * plate.subdomains, {nodes, places, stiffness, Eigen::VectorXd::Zero(4)});
    }
}

/// The plate as FETI-DP takes it; each rank has a run of the subdomains.
std::shared_ptr<const UnassembledProblem> handOver(const Plate& plate, const RCP<const Comm>& comm) {
  const int number = plate.subdomains * plate.subdomains;
  ElementMatrices matrices(2);
  for (int k = 0; k < number; ++k)
    if (k * comm->getSize() / number == comm->getRank())
      addElements(plate, k % plate.subdomains, k / plate.subdomains, matrices);
  const auto problem = std::make_shared<UnassembledProblem>(comm, 2, 1, std::vector<std::string>{"plate"});
  for (SubdomainMatrix& matrix : matrices.take()) {
    for (const GlobalOrdinal unknown : matrix.unknowns)
      if (const GlobalOrdinal i = unknown % (plate.elements + 1); i == 0 || i == plate.elements)
        matrix.prescribed.emplace_back(unknown, i == 0 ? 20.0 : 0.0);
    problem->add(std::move(matrix));
  }
  problem->complete();
  return problem;
}

int conduct(const std::string& list, const Plate& plate, const RCP<const Comm>& comm) {
  const auto problem = handOver(plate, comm);
  linear::GlobalUnknowns unknowns;
  for (std::size_t s = 0; s < problem->numSubdomains(); ++s)
    unknowns.push_back(problem->globalUnknowns(s));
  const RCP<const linear::UnassembledOperator> k = rcp(new linear::UnassembledOperator(
      std::shared_ptr<const DecomposedProblem>(problem, &problem->problem()), unknowns));

  // From here on it is as with any other solver of Stratimikos.
  const auto strategy = adapters::linearSolveStrategy(Teuchos::getParametersFromXmlFile(list));
  const auto forward = adapters::asThyra(k);
  const auto solver = Thyra::linearOpWithSolve<double>(*strategy, forward); // factorises

  const RCP<Vector> load = k->load(problem->data()),
                    temperature = rcp(new Vector(k->getDomainMap())); // starts at 0
  bool isSolved = true;
  for (const int height : {plate.elements / 2, plate.elements / 4}) { // a source of power 1 each
    if (const GlobalOrdinal node = plate.node(plate.elements / 2, height);
        load->getMap()->isNodeGlobalElement(node))
      load->sumIntoGlobalValue(node, 1.0);
    const auto status = solver->solve(Thyra::NOTRANS, *Thyra::createVector<double>(load, forward->range()),
                                      Thyra::createVector<double>(temperature, forward->domain()).ptr());
    isSolved = isSolved && status.solveStatus == Thyra::SOLVE_STATUS_CONVERGED;
    const double mean = temperature->meanValue();
    if (comm->getRank() == 0)
      std::cout << "mean temperature " << mean << ", " << status.extraParameters->get<int>("Iteration Count")
                << " iterations, relative residual " << status.achievedTol << ": " << status.message << '\n';
  }
  return isSolved ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  try {
    if (argc != 2 && argc != 4)
      throw std::invalid_argument(
          "usage: example-heat-conduction LIST.xml [ELEMENTS SUBDOMAINS], each along a side");
    return conduct(argv[1], {argc > 2 ? std::stoi(argv[2]) : 128, argc > 2 ? std::stoi(argv[3]) : 8}, comm);
  } catch (const std::exception& error) { // Epafi's errors are the same on all ranks
    if (comm->getRank() == 0)
      std::cerr << error.what() << '\n';
    return 2;
  }
}
