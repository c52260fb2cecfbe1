/// A membrane over an obstacle, preconditioned by MueLu.

#include "MueLuPreconditioner.hpp"
#include "Obstacle.hpp"

#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

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
  const auto [a, load, floor] = makeObstacle(n, comm);

  qp::QuadraticProgram problem;
  problem.hessian = a;
  problem.linearTerm = load;
  problem.set = rcp(new qp::Box(floor));
  problem.preconditioner = makeMueLu(a);
  Vector u(a->getDomainMap());
  const qp::SolveReport report = qp::QpSolver().solve(problem, u).report;

  if (comm->getRank() == 0)
    std::cout << toString(report.status) << ": " << report.reason << '\n'
              << report.counts.hessianMultiplications << " products, "
              << report.counts.preconditionerApplications << " V-cycles\nKKT residuals: stationarity "
              << report.kkt.stationarity << ", signs of multipliers " << report.kkt.dualFeasibility
              << ", complementarity " << report.kkt.complementarity << '\n';
  return report.status == qp::Status::converged ? 0 : 1;
}
