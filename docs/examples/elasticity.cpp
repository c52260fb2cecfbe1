// A block of an application's own mesh, pressed up against a rigid circle: element matrices in, displacements
// out. Prints the displacements of all nodes, row by row from below; test/consumer/circle.xml is the same
// problem as a scene.
#include "epafi/ContactSolver.hpp"
#include "epafi/decomposition/ElementMatrices.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

using epafi::GlobalOrdinal;

constexpr int nx = 32, ny = 16, cutX = 4, cutY = 2; // elements, and the subdomains they are cut into
constexpr double width = 2, height = 1, young = 200, poisson = 0.3, lift = 0.02, radius = 3;

GlobalOrdinal node(int i, int j) {
  return GlobalOrdinal{j} * (nx + 1) + i;
}

/// Bilinear plane strain, 2 x 2 Gauss points, two unknowns a node; all elements are equal.
Eigen::MatrixXd elementStiffness() {
  constexpr double hx = width / nx, hy = height / ny;
  Eigen::Matrix3d law;
  law << 1 - poisson, poisson, 0, poisson, 1 - poisson, 0, 0, 0, 0.5 - poisson;
  law *= young / ((1 + poisson) * (1 - 2 * poisson));
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(8, 8);
  for (const double x : {-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)})
    for (const double y : {-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)}) {
      Eigen::Matrix<double, 3, 8> strain = Eigen::Matrix<double, 3, 8>::Zero();
      for (int a = 0; a < 4; ++a) { // counter-clockwise
        const int sx = a == 1 || a == 2 ? 1 : -1, sy = a >= 2 ? 1 : -1;
        strain(0, 2 * a) = strain(2, 2 * a + 1) = sx * (1 + sy * y) / (2 * hx);
        strain(1, 2 * a + 1) = strain(2, 2 * a) = sy * (1 + sx * x) / (2 * hy);
      }
      stiffness += strain.transpose() * law * strain * hx * hy / 4;
    }
  return stiffness;
}

/// The subdomains of this rank, each from its elements; the bottom is lifted.
void addSubdomains(epafi::decomposition::UnassembledProblem& problem, int rank, int numRanks) {
  const Eigen::MatrixXd stiffness = elementStiffness();
  epafi::decomposition::ElementMatrices elements(2);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int subdomain = j * cutY / ny * cutX + i * cutX / nx;
      if (subdomain * numRanks / (cutX * cutY) != rank)
        continue;
      std::array<GlobalOrdinal, 8> unknowns{};
      Eigen::MatrixXd places(8, 2);
      for (int a = 0; a < 4; ++a) {
        const int right = i + (a == 1 || a == 2 ? 1 : 0), up = j + (a >= 2 ? 1 : 0);
        for (int c = 0; c < 2; ++c) {
          const int place = 2 * a + c;
          unknowns[static_cast<std::size_t>(place)] = 2 * node(right, up) + c;
          places.row(place) << width * right / nx, height * up / ny;
        }
      }
      elements.add(subdomain, {unknowns, places, stiffness, Eigen::VectorXd::Zero(8)});
    }
  for (epafi::decomposition::SubdomainMatrix& matrix : elements.take()) {
    for (const GlobalOrdinal unknown : matrix.unknowns)
      if (unknown < 2 * (nx + 1))
        matrix.prescribed.emplace_back(unknown, unknown % 2 == 0 ? 0.0 : lift);
    problem.add(std::move(matrix));
  }
}

/// No node of the top comes into the circle that touches it in the middle: d'u <= distance, d towards the
/// centre.
epafi::decomposition::ConstraintMatrix contact(const epafi::RCP<const epafi::Comm>& comm) {
  const auto rows = Teuchos::rcp(new epafi::Map(nx + 1, 0, comm));
  const auto unknowns = Teuchos::rcp(new epafi::Map(2 * (nx + 1) * (ny + 1), 0, comm));
  const auto matrix = Teuchos::rcp(new epafi::CrsMatrix(rows, 2));
  const auto gap = Teuchos::rcp(new epafi::Vector(rows));
  for (int i = 0; i <= nx; ++i)
    if (rows->isNodeGlobalElement(i)) {
      const Eigen::Vector2d way =
          Eigen::Vector2d(0.5 * width, height + radius) - Eigen::Vector2d(width * i / nx, height);
      const Eigen::Vector2d d = way.normalized();
      matrix->insertGlobalValues(i, Teuchos::tuple<GlobalOrdinal>(2 * node(i, ny), 2 * node(i, ny) + 1),
                                 Teuchos::tuple(d[0], d[1]));
      gap->replaceGlobalValue(i, way.norm() - radius);
    }
  matrix->fillComplete(unknowns, rows);
  return {matrix, gap};
}

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  epafi::decomposition::UnassembledProblem problem(comm, 2, 2, {"block"});
  addSubdomains(problem, comm->getRank(), comm->getSize());
  problem.setContact(contact(comm));
  problem.complete();

  Teuchos::ParameterList parameters("Solver");
  parameters.set("Tolerance", 1e-13);
  epafi::ContactSolver solver(parameters);
  solver.setup(problem.problem(), problem.data());
  const auto u = problem.unknowns(solver.solve(problem.data()).displacement);

  const std::size_t all = comm->getRank() == 0 ? 2 * (nx + 1) * (ny + 1) : 0; // the first rank prints
  epafi::Vector first(Teuchos::rcp(new epafi::Map(2 * (nx + 1) * (ny + 1), all, 0, comm)));
  first.doImport(*u, epafi::Import(u->getMap(), first.getMap()), Tpetra::INSERT);
  for (std::size_t i = 0; i < all; i += 2)
    std::printf("%.17g %.17g\n", first.getData()[static_cast<int>(i)],
                first.getData()[static_cast<int>(i) + 1]);
  return solver.report().status == epafi::qp::Status::converged ? 0 : 1;
}
