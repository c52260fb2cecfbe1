#pragma once

/// A draw as an application's problem, and what Epafi makes of it beside the independent solver.

#include "FrictionDraw.hpp"
#include "FrictionOracle.hpp"

#include "support/HandedOver.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/decomposition/FrictionRows.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::test {

/// A draw as an application's problem, and what the two solvers make of it.
struct Trial {
  Trial(const Draw& drawn, const scene::Decomposition& cut);

  void assemble(const std::vector<decomposition::SubdomainMatrix>& matrices,
                const decomposition::ConstraintMatrix& contact, decomposition::FrictionRows& friction);

  /// c, with c_t where friction can do something about it.
  void drawJumps(const decomposition::ConstraintMatrix& contact, decomposition::FrictionRows& friction);

  void solve();

  [[nodiscard]] int products() const { return solver->report().counts.hessianMultiplications; }
  /// Whether one method gave way to another.
  [[nodiscard]] bool fellBack() const;
  [[nodiscard]] bool converged() const { return solver->report().status == qp::Status::converged; }

  Draw draw;
  Whole whole;
  std::unique_ptr<decomposition::UnassembledProblem> problem;
  decomposition::ProblemData data;
  std::unique_ptr<ContactSolver> solver;
  fetidp::ContactSolution solution;
  std::string refusal;
  VectorXd u, force, state;
};

} // namespace epafi::test
