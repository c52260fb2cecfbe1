#pragma once

/// Benchmarks on all ranks together, and on each rank alone.

#include "Problems.hpp"

#include "epafi/benchmarks/BoundBenchmark.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>

namespace epafi::test {

inline RCP<const Comm> allRanks() {
  return Tpetra::getDefaultComm();
}

/// The communicator of this rank alone.
inline RCP<const Comm> thisRank() {
  return rcp(new Teuchos::SerialComm<int>());
}

struct BenchmarkSolution {
  RCP<Vector> x;
  qp::SolveReport report;
};

/// From 0, with the default parameters.
inline BenchmarkSolution solve(const benchmarks::BoundBenchmark& benchmark, double tolerance) {
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", tolerance);
  const RCP<Vector> x = rcp(new Vector(benchmark.hessian->getDomainMap()));
  return {x, qp::QpSolver(parameters).solve(benchmark.program(), *x).report};
}

/// The whole matrix on every rank.
inline Eigen::MatrixXd dense(const Operator& a) {
  const Eigen::Index n = a.getDomainMap()->getGlobalNumElements();
  const Eigen::Index m = a.getRangeMap()->getGlobalNumElements();
  Eigen::MatrixXd result(m, n);
  Vector image(a.getRangeMap());
  for (Eigen::Index k = 0; k < n; ++k) {
    a.apply(*makeVector(a.getDomainMap(), [k](int i) { return i == k ? 1.0 : 0.0; }), image);
    result.col(k) = gather(image);
  }
  return result;
}

} // namespace epafi::test
