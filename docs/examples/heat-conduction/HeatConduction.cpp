/// Heat conduction in a square plate, −∇·(κ∇T) = q, by FETI-DP through Stratimikos:
///     HeatConduction LIST.xml [ELEMENTS SUBDOMAINS]
/// The left side is kept at T = 20, the right one at 0, the others are insulated. Two bars conduct a thousand times as well as
/// the rest. Once the matrix is factorised two sources of heat are solved for, one after the other.

#include "epafi/adapters/Stratimikos.hpp"
#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fetidp/ThyraOperators.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <exception>
#include <iostream>
#include <memory>
#include <string>

using namespace epafi;

namespace {

/// The plate, cut into squares.
scene::Scene plate(int elements, int subdomains) {
  using scene::Edge;
  scene::Body body;
  body.name = "plate";
  body.elements = {elements, elements};
  body.regions = {{"lower bar", {0.1, 0.9, 0.25, 0.3}, 1000}, {"upper bar", {0.1, 0.9, 0.7, 0.75}, 1000}};
  body.supports = {{"warm", Edge::left, 20.0}, {"cold", Edge::right, 0.0}};
  body.decomposition.counts = {subdomains, subdomains, 1};
  scene::Scene scene;
  scene.bodies = {body};
  return scene;
}

/// Adds a source of heat of power 1 at a node.
void addSource(Vector& load, GlobalOrdinal node) {
  if (load.getMap()->isNodeGlobalElement(node))
    load.sumIntoGlobalValue(node, 1.0);
}

int conduct(const std::string& list, int elements, int subdomains, const RCP<const Comm>& comm) {
  // The subdomains' matrices, each of a rank's own, and the numbers of their unknowns in the whole. An application hands
  // over its own (decomposition::DecomposedProblem).
  const auto cut =
      std::make_shared<const decomposition::Decomposition>(decomposition::decompose(plate(elements, subdomains), comm));
  const RCP<const linear::UnassembledOperator> k = rcp(new linear::UnassembledOperator(
      std::shared_ptr<const decomposition::DecomposedProblem>(cut, &cut->problem), linear::globalUnknowns(*cut)));

  // From here on it is as with any other solver of Stratimikos.
  const auto strategy = adapters::linearSolveStrategy(Teuchos::getParametersFromXmlFile(list));
  const auto forward = fetidp::asThyra(k);
  const auto solver = Thyra::linearOpWithSolve<double>(*strategy, forward); // factorises

  const GlobalOrdinal row = elements + 1, middle = row * (elements / 2) + elements / 2;
  const RCP<Vector> load = k->load(), temperature = rcp(new Vector(k->getDomainMap())); // starts at 0
  bool isSolved = true;
  for (const GlobalOrdinal node : {middle, middle + row * (elements / 4)}) {
    addSource(*load, node);
    const auto status = solver->solve(Thyra::NOTRANS, *Thyra::createVector<double>(load, forward->range()),
                                      Thyra::createVector<double>(temperature, forward->domain()).ptr());
    isSolved = isSolved && status.solveStatus == Thyra::SOLVE_STATUS_CONVERGED;
    const double highest = temperature->normInf(); // T > 0 everywhere
    if (comm->getRank() == 0)
      std::cout << "highest temperature " << highest << ", " << status.extraParameters->get<int>("Iteration Count")
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
      throw std::invalid_argument("usage: HeatConduction LIST.xml [ELEMENTS SUBDOMAINS], each along a side");
    return conduct(argv[1], argc > 2 ? std::stoi(argv[2]) : 128, argc > 2 ? std::stoi(argv[3]) : 8, comm);
  } catch (const std::exception& error) { // Epafi's errors are the same on all ranks
    if (comm->getRank() == 0)
      std::cerr << error.what() << '\n';
    return 2;
  }
}
