#pragma once

/// The facade: a decomposed contact problem in, its solution with a certificate out.
///
///     ContactSolver solver(parameters);
///     solver.setup(problem, data);            // factorises; once a matrix
///     ContactSolution a = solver.solve(data);
///     data.scaleLoads(2);                     // new loads, supports and gaps: no new setup
///     ContactSolution b = solver.solve(data, a.multiplier.get());
///     problem.subdomains[0].stiffness = k;    // new matrices, new rows of B: what still holds is kept
///     solver.update(data);

#include "epafi/fetidp/solve/ContactResponse.hpp"
#include "epafi/fetidp/solve/ContactSolution.hpp"
#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/qp/solve/Interruption.hpp"

#include <Teuchos_ParameterList.hpp>

#include <memory>
#include <span>
#include <string>

namespace epafi {

/// Seconds of the parts of a run, the largest over the ranks.
struct SolverTimes {
  double setup = 0, solve = 0, recovery = 0;
};

/// What a problem was, how it was solved and what that took, in numbers; over all ranks.
struct SolveFacts : fetidp::PlanFacts {
  GlobalOrdinal dualDimension = 0, numCrosspoints = 0; ///< DecomposedProblem has the meaning
  int numAdaptiveConstraints = 0, numSubdomains = 0, numClusters = 0, numRanks = 0;
  fetidp::Plan plan;                         ///< all choices, with reasons
  std::string preconditioner, dualOperator;  ///< in some words
  std::string subdomainSolver, coarseSolver; ///< names of direct solvers
  double operatorNorm = 0;                   ///< estimate of ‖F‖
  int normMultiplications = 0;               ///< products with F that it took
  qp::StepCounts counts;                     ///< of the iteration
  SolverTimes times;
  double peakBytes = 0, factorBytes = 0; ///< most that the processes ever held; factors and dense blocks
  qp::Status status = qp::Status::maxIterations;
  std::string statusReason; ///< one sentence
};

class ContactSolver {
public:
  /// All parameters with defaults, ranges and meaning.
  static Teuchos::ParameterList validParameters();

  /// \param run  what is known beside the problem
  /// \throws InputError if the list is not valid. Not collective.
  explicit ContactSolver(const Teuchos::ParameterList& parameters, const fetidp::RunFacts& run = {});

  /// Factorises the subdomains and the coarse problem, chooses the algorithm, estimates ‖F‖. Keeps a
  /// reference to `problem`, which must outlive the solver. Collective.
  /// \param data  what a refusal says the loads make of a body that nothing holds; no more comes from it
  /// \throws InputError, SolvabilityError or Error, the same on all ranks.
  void setup(const decomposition::DecomposedProblem& problem, const decomposition::ProblemData& data);

  /// Follows changes that the problem of `setup` has seen since: matrices K^s (another object with the same
  /// pattern) and rows of B. Less than `setup`: subdomains whose matrix is the
  /// same object, with B at the same unknowns as before, keep their factors; others are factorised
  /// numerically, their ordering and symbolic part kept. The algorithm is chosen, ‖F‖ estimated and the
  /// preconditioner made anew; its blocks are kept where factors are. What earlier calls returned stays valid
  /// but for references into dualProblem(). Collective. \throws as `setup`. Preconditions: `setup` was
  /// called; subdomains, unknowns and crosspoints are the same.
  void update(const decomposition::ProblemData& data);

  /// Solves for these loads, prescribed values and gaps. Where the tolerance is met but the
  /// displacements violate the constraints still, it is settled (fetidp/Recovery.hpp); the report counts
  /// those steps, too, which the observer is not told of, but may end. A solution that misses the tolerance
  /// is returned as well: ask `report().status`.
  /// \param data      of the problem of `setup`, as it was at the last `setup` or `update`
  /// \param start     λ of an earlier solve to start from, or null
  /// \param observer  told of every step, shown λ where it wants to look, may end the iteration
  /// (`interrupted`); or null
  /// \param balance   with the tolerance 'balanced': who estimates the discretisation error; else null
  /// Collective. Precondition: `setup` was called.
  /// \throws SolvabilityError or InputError (a load or gap that is not finite), the same on all ranks.
  fetidp::ContactSolution solve(const decomposition::ProblemData& data, const Vector* start = nullptr,
                                qp::Observer* observer = nullptr,
                                const fetidp::ErrorBalance* balance = nullptr);

  /// λ to start from, of a guess of the displacements, say from a coarser mesh: see
  /// fetidp::DualProblem::startFrom. Null where there is nothing to iterate, or no preconditioner of type
  /// dirichlet. Precondition: `setup` was called. Collective.
  [[nodiscard]] RCP<Vector> startFrom(const decomposition::ProblemData& data,
                                      std::span<const Eigen::VectorXd> displacement) const {
    return dual_->startFrom(data, displacement);
  }

  /// How a solution changes with loads and gaps while its closed contacts stay closed and its open ones open:
  /// a linear problem, for sensitivities and for the errors of quantities; see fetidp::contactResponse.
  /// Precondition: `setup` was called, and `solution` is one of its problem. Leaves report() as it is.
  /// Collective.
  [[nodiscard]] fetidp::ContactResponse respond(const fetidp::ContactSolution& solution,
                                                const fetidp::DataChange& change,
                                                double tolerance = 1e-6) const {
    return fetidp::contactResponse(*dual_, *solution.active, change, tolerance);
  }

  /// Of the last solve.
  [[nodiscard]] const qp::SolveReport& report() const { return report_; }
  [[nodiscard]] const SolverTimes& times() const { return times_; } ///< of the last set-up and solve
  /// What the iteration works on. Precondition: `setup` was called.
  [[nodiscard]] const fetidp::DualProblem& dualProblem() const { return *dual_; }
  /// What `setup` will choose for the problem, as far as it is known before. Collective.
  [[nodiscard]] fetidp::Plan planFor(const decomposition::DecomposedProblem& problem) const {
    return fetidp::plan(fetidp::factsOf(problem, run_), dualParameters_);
  }
  /// All choices; before `setup` those that do not depend on the problem, such as the tolerance.
  [[nodiscard]] const fetidp::Plan& plan() const { return dual_ ? dual_->plan() : plan_; }

  /// Of the last solve. Collective. Precondition: there was one.
  [[nodiscard]] SolveFacts facts() const;

private:
  void factorise(const decomposition::ProblemData& data, std::shared_ptr<fetidp::GeneralizedInverse> earlier);
  void confirm(const fetidp::ContactSolution& solution, double errorTarget);
  [[nodiscard]] double algebraicErrorOf(const decomposition::ProblemData& data,
                                        const fetidp::ContactSolution& solution) const;
  void measureFeedback(const decomposition::ProblemData& data, const qp::Interruption& interruption,
                       fetidp::ContactSolution& solution) const;
  void settle(const decomposition::ProblemData& data, fetidp::DualSolution dual,
              const qp::Interruption& interruption, fetidp::ContactSolution& solution);
  [[nodiscard]] std::string describeDualOperator() const;
  [[nodiscard]] std::string describePreconditioner() const;
  [[nodiscard]] int numAdaptiveConstraints() const;

  fetidp::DualParameters dualParameters_;
  fetidp::RunFacts run_;
  fetidp::Plan plan_;
  const decomposition::DecomposedProblem* problem_ = nullptr;
  std::shared_ptr<fetidp::GeneralizedInverse> inverse_;
  std::unique_ptr<fetidp::DualProblem> dual_;
  qp::SolveReport report_;
  SolverTimes times_;
};

} // namespace epafi
