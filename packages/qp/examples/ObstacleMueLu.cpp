/// A membrane over an obstacle, preconditioned by MueLu:
///     min ∫ ½|∇u|² + 8u over u ≥ −0.3, u = 0 on the border of the unit square.

#include "MueLuPreconditioner.hpp"

#include "epafi/qp/Box.hpp"
#include "epafi/qp/QpSolver.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <iostream>
#include <string>

using namespace epafi;

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const GlobalOrdinal n = argc > 1 ? std::stoi(argv[1]) : 100;
  const double h = 1.0 / static_cast<double>(n + 1);

  // The five-point Laplacian times h²; every rank fills the rows that it owns.
  const RCP<const Map> map = rcp(new Map(static_cast<std::size_t>(n * n), 0, comm));
  const RCP<CrsMatrix> a = rcp(new CrsMatrix(map, 5));
  for (GlobalOrdinal row = map->getMinGlobalIndex(); row <= map->getMaxGlobalIndex(); ++row) {
    const auto couple = [&](GlobalOrdinal to, double value) { a->insertGlobalValues(row, 1, &value, &to); };
    couple(row, 4.0);
    if (row % n > 0)
      couple(row - 1, -1.0);
    if (row % n < n - 1)
      couple(row + 1, -1.0);
    if (row >= n)
      couple(row - n, -1.0);
    if (row < n * n - n)
      couple(row + n, -1.0);
  }
  a->fillComplete();

  const RCP<Vector> load = rcp(new Vector(map)), floor = rcp(new Vector(map));
  load->putScalar(-8 * h * h);
  floor->putScalar(-0.3);

  qp::QuadraticProgram problem;
  problem.hessian = a;
  problem.linearTerm = load;
  problem.set = rcp(new qp::Box(floor));
  problem.preconditioner = makeMueLu(a);
  Vector u(map);
  const qp::SolveReport report = qp::QpSolver().solve(problem, u).report;

  if (comm->getRank() == 0)
    std::cout << toString(report.status) << ": " << report.reason << '\n'
              << report.counts.hessianMultiplications << " products, "
              << report.counts.preconditionerApplications << " V-cycles\nKKT residuals: stationarity "
              << report.kkt.stationarity << ", signs of multipliers " << report.kkt.dualFeasibility
              << ", complementarity " << report.kkt.complementarity << '\n';
  return report.status == qp::Status::converged ? 0 : 1;
}
