#pragma once

/// K u = b by FETI-DP: conjugate gradients on F with a Dirichlet preconditioner, and u from λ. A linear
/// problem without contact; contact is for ContactSolver.

#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/linear/DualIteration.hpp"
#include "epafi/linear/LinearParameters.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace epafi::linear {

/// How a solve ended. Residuals are those of K u = b, computed afresh.
struct LinearReport {
  bool converged = false;
  std::string reason; ///< one sentence
  int iterations = 0; ///< conjugate gradient steps, of all columns at once
  /// ‖b − Ku‖ of each column relative to its reference; absolute where that vanishes.
  std::vector<double> relativeResiduals;
  /// Of all columns; 0 if there are none.
  [[nodiscard]] double largestResidual() const;
};

/// What a residual is relative to.
enum class ResidualReference { rightHandSide, startResidual };

class FetiDpSolver {
public:
  /// Factorises; shares k. Collective.
  /// \throws InputError if the problem has rows of contact or an entry that is no finite number,
  /// SolvabilityError (not unique) if a body floats, Error if a factorisation fails; the same on all ranks.
  FetiDpSolver(RCP<const UnassembledOperator> k, const FetiDpParameters& parameters);

  /// Follows a change of the matrices in the problem of k: what still holds is kept (see GeneralizedInverse),
  /// the symbolic part of factorisations where patterns are the same. Collective; throws as the constructor
  /// does, and solves have to wait until an update succeeds.
  void update();

  /// Solves for all columns at once, none of which takes a factorisation.
  /// \param b  n × k; \param x  n × k: in: start (a product with K more than zero), out: the solution
  /// \param tolerance  on ‖b − Kx‖ relative to `reference`, column by column
  /// A solve that does not reach it says so in the report, and x is the best that was found. Collective.
  /// \throws InputError, the same on all ranks, if b or x has an entry that is no finite number.
  LinearReport solve(const MultiVector& b, MultiVector& x, double tolerance,
                     ResidualReference reference = ResidualReference::rightHandSide);
  /// To the tolerance of the parameters, relative to the right-hand side.
  LinearReport solve(const MultiVector& b, MultiVector& x) { return solve(b, x, parameters_.tolerance); }

  /// As given.
  [[nodiscard]] const FetiDpParameters& parameters() const { return parameters_; }
  /// F and its preconditioner, for who wants to look.
  [[nodiscard]] const fetidp::DualProblem& dualProblem() const { return *dual_; }
  /// K.
  [[nodiscard]] const RCP<const UnassembledOperator>& forwardOperator() const { return k_; }

private:
  struct Columns;
  void prepare();
  Columns begin(const MultiVector& b, MultiVector& x, double tolerance, ResidualReference reference) const;
  bool improve(Columns& columns, int maxSteps, DualOutcome& outcome);
  DualOutcome correct(const MultiVector& residual, std::span<const double> goals, int maxSteps,
                      MultiVector& x);
  DualOutcome solveDual(std::span<const double> goals, int maxSteps);

  RCP<const UnassembledOperator> k_;
  FetiDpParameters parameters_;
  std::shared_ptr<fetidp::GeneralizedInverse> inverse_;
  std::unique_ptr<fetidp::DualProblem> dual_;
  std::unique_ptr<CopyShares> shares_;
  std::unique_ptr<PrimalResidual> primal_;
  std::unique_ptr<fetidp::MultiplierExchange> multipliers_;
  fetidp::GeneralizedInverse::Workspace work_;
  SubdomainVectors forces_, torn_; ///< work: f̄ or f̄ − B̄ᵀλ, and the torn solution
};

} // namespace epafi::linear
