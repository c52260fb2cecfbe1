#include "epafi/benchmarks/BoundBenchmark.hpp"

#include "epafi/qp/Box.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::benchmarks {

qp::QuadraticProgram BoundBenchmark::program() const {
  qp::QuadraticProgram problem;
  problem.hessian = hessian;
  problem.linearTerm = linearTerm;
  problem.set = rcp(new qp::Box(lower, upper));
  return problem;
}

RCP<Vector> BoundBenchmark::error(const Vector& u) const {
  const RCP<Vector> result =
      grid.vector(u.getMap(), [&](int i, int j) { return exactSolution(grid.x(i), grid.y(j)); });
  result->update(1.0, u, -1.0);
  return result;
}

} // namespace epafi::benchmarks
