#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/QpSolver.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <iostream>

using namespace epafi; // Vector = Tpetra::Vector<double>, and so on: epafi/base/Types.hpp

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const GlobalOrdinal n = 100;
  const double h = 1.0 / (n + 1);

  // A string, held at both ends: −u″ on n inner nodes, times h².
  const RCP<const Map> map = rcp(new Map(n, 0, comm));
  const RCP<CrsMatrix> a = rcp(new CrsMatrix(map, 3));
  for (GlobalOrdinal row = map->getMinGlobalIndex(); row <= map->getMaxGlobalIndex(); ++row) {
    const GlobalOrdinal first = std::max<GlobalOrdinal>(row - 1, 0), last = std::min(row + 1, n - 1);
    for (GlobalOrdinal column = first; column <= last; ++column) {
      const double value = row == column ? 2.0 : -1.0;
      a->insertGlobalValues(row, 1, &value, &column);
    }
  }
  a->fillComplete();

  // Its weight pulls it down; a floor stops it.
  const RCP<Vector> load = rcp(new Vector(map)), floor = rcp(new Vector(map));
  load->putScalar(-h * h);
  floor->putScalar(-0.1);

  qp::QuadraticProgram problem; // min ½uᵀAu − bᵀu, u ≥ −0.1
  problem.hessian = a;
  problem.linearTerm = load;
  problem.set = rcp(new qp::Box(floor));

  Vector u(map); // the start, 0; then the solution
  qp::QpSolver solver;
  const qp::QpSolution solution = solver.solve(problem, u);

  const double force = solution.boundMultiplier->norm1(); // all ranks take part in a norm
  if (comm->getRank() == 0)
    std::cout << toString(solution.report.status) << ": " << solution.report.reason << '\n'
              << solution.report.counts.hessianMultiplications << " products, stationarity "
              << solution.report.kkt.stationarity << ", the floor carries " << force / h << '\n';
  return solution.report.status == qp::Status::converged ? 0 : 1;
}
