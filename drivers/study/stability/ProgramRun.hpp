#pragma once

/// One quadratic program as dense data, solved by qp::QpSolver and checked from these data alone.

#include "StabilityCase.hpp"

#include "epafi/benchmarks/DenseProgram.hpp"
#include "epafi/qp/QpSolver.hpp"

#include <Teuchos_ParameterList.hpp>

#include <functional>

namespace epafi::drivers {

struct ProgramTask {
  benchmarks::DenseProgram program;
  Eigen::VectorXd start = {}; ///< 0 if empty
  double tolerance = 1e-8;
  Teuchos::ParameterList parameters =
      Teuchos::ParameterList(); ///< what differs from the defaults, tolerances aside
};

/// What the solver returned, on every rank.
struct ProgramAnswer {
  CaseResult result;
  Eigen::VectorXd x, boundMultiplier, equalityMultiplier;
};

/// The program over sparse matrices. Collective.
qp::QuadraticProgram toQuadraticProgram(const benchmarks::DenseProgram& program, const RCP<const Comm>& comm);

/// Outcome: solved if the conditions of Karush, Kuhn and Tucker hold, recomputed in extended precision; noSolution if the
/// certificate of it does; stopped; or wrongAnswer. Collective. \throws InputError, the same on all ranks.
ProgramAnswer solveProgram(const ProgramTask& task, const RCP<const Comm>& comm);

} // namespace epafi::drivers
