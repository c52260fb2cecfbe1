#include "epafi/benchmarks/BoundBenchmark.hpp"

#include "epafi/qp/constraints/Box.hpp"

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

} // namespace epafi::benchmarks
