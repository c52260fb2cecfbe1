#include "epafi/linear/DualIteration.hpp"

#include "epafi/linear/NodalBasis.hpp"
#include "epafi/qp/solve/BelosIteration.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace epafi::linear {
namespace {

/// Passes when every column has met its goal, when one has met it so far that its steps would soon divide
/// zero by zero, or at the limit.
class PrimalGoal final : public qp::BelosTest {
public:
  PrimalGoal(PrimalResidual& primal, std::vector<double> goals, int maxSteps)
      : primal_(primal), goals_(std::move(goals)), maxSteps_(maxSteps),
        expected_(goals_.size(), std::numeric_limits<double>::infinity()), dual_(goals_.size()),
        isMet_(goals_.size(), 0) {}

  Belos::StatusType checkStatus(qp::BelosIteration* iteration) override {
    const auto residual = iteration->getNativeResiduals(nullptr);
    residual->norm2(Teuchos::arrayViewFromVector(dual_));
    if (isTimeToLook())
      look(*residual);
    const bool isDone = std::all_of(isMet_.begin(), isMet_.end(), [](char met) { return met != 0; });
    status_ =
        isDone || hasSpentColumn() || iteration->getNumIters() >= maxSteps_ ? Belos::Passed : Belos::Failed;
    return status_;
  }
  [[nodiscard]] Belos::StatusType getStatus() const override { return status_; }
  void reset() override { status_ = Belos::Failed; }
  void print(std::ostream& /*stream*/, int /*indent*/) const override {}
  [[nodiscard]] bool isMet(std::size_t column) const { return isMet_[column] != 0; }

private:
  /// Whether all columns may have met their goals, or one has fallen so far that it must not go on unseen.
  [[nodiscard]] bool isTimeToLook() const {
    bool isTime = true;
    for (std::size_t j = 0; j < dual_.size(); ++j) {
      if (isMet_[j] == 0 && dual_[j] <= 1e-3 * expected_[j])
        return true;
      isTime = isTime && (isMet_[j] != 0 || dual_[j] <= expected_[j]);
    }
    return isTime;
  }
  void look(const MultiVector& residual) {
    primal_.norms(residual, norms_);
    for (std::size_t j = 0; j < dual_.size(); ++j) {
      isMet_[j] = norms_[j] <= goals_[j] ? 1 : 0;
      // The ratio of both norms changes slowly.
      expected_[j] = norms_[j] > 0 ? dual_[j] * std::min(0.5, goals_[j] / norms_[j]) : 0.0;
    }
  }
  [[nodiscard]] bool hasSpentColumn() const {
    for (std::size_t j = 0; j < dual_.size(); ++j)
      if (isMet_[j] != 0 && dual_[j] <= 1e-6 * expected_[j])
        return true;
    return false;
  }

  PrimalResidual& primal_;
  std::vector<double> goals_;
  int maxSteps_;
  std::vector<double> expected_; ///< dual norms at which to look again
  std::vector<double> dual_, norms_;
  std::vector<char> isMet_;
  Belos::StatusType status_ = Belos::Failed;
};

} // namespace

PrimalResidual::PrimalResidual(const UnassembledOperator& k, const fetidp::GeneralizedInverse& inverse,
                               fetidp::PreconditionerParameters::Scaling scaling)
    : k_(k), exchange_(inverse.multiplierPlan()), residual_(rcp(new MultiVector(k.getRangeMap(), 1))) {
  const fetidp::ContactCrosspoints none(k.problem(), inverse, k.problem().comm);
  weights_ =
      std::move(fetidp::scaleConstraint(k.problem(), none, scaling, inverse.multiplierPlan()).boundary);
}

void PrimalResidual::norms(const MultiVector& r, std::vector<double>& result) {
  const Eigen::Index numColumns = r.getNumVectors();
  if (residual_->getNumVectors() != r.getNumVectors())
    residual_ = rcp(new MultiVector(k_.getRangeMap(), r.getNumVectors()));
  const auto values = exchange_.toSubdomains(r);
  const Eigen::Index stride = std::ssize(values) / numColumns;
  const auto& subdomains = k_.problem().subdomains;
  jumps_.resize(subdomains.size());
  forces_.resize(subdomains.size());
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    jumps_[s].setZero(subdomains[s].stiffness->rows(), numColumns);
    for (Eigen::Index j = 0; j < numColumns; ++j) {
      const double* multipliers = values.data() + j * stride;
      const double* weight = weights_[s].data();
      for (const auto& entry : subdomains[s].constraint)
        jumps_[s](entry.unknown, j) += *weight++ * multipliers[entry.multiplier]; // B_Dᵀ r
    }
    forces_[s].noalias() = *subdomains[s].stiffness * jumps_[s];
    toForcesOfValues(subdomains[s], forces_[s]);
  }
  k_.exchange().sum(forces_, *residual_);
  result.resize(r.getNumVectors());
  residual_->norm2(Teuchos::arrayViewFromVector(result));
}

DualOutcome iterateDual(const RCP<const Operator>& f, const RCP<const Operator>& m,
                        const RCP<const MultiVector>& rhs, const RCP<MultiVector>& lambda,
                        PrimalResidual& primal, std::span<const double> goals, int maxSteps) {
  const RCP<qp::BelosProblem> problem = rcp(new qp::BelosProblem(f, lambda, rhs));
  if (!m.is_null())
    problem->setLeftPrec(m);
  std::vector<int> open(goals.size()); // columns that have not met their goals
  std::iota(open.begin(), open.end(), 0);
  DualOutcome outcome;
  while (!open.empty() && outcome.steps < maxSteps) {
    std::vector<double> openGoals;
    for (const int column : open)
      openGoals.push_back(goals[column]);
    const RCP<PrimalGoal> goal = rcp(new PrimalGoal(primal, openGoals, maxSteps - outcome.steps));
    const qp::BelosOutcome steps = qp::iterate(problem, open, goal);
    outcome.steps += steps.steps;
    if (steps.isIndefinite) {
      outcome.status = DualOutcome::Status::indefinite;
      return outcome;
    }
    std::vector<int> left;
    for (std::size_t j = 0; j < open.size(); ++j)
      if (!goal->isMet(j))
        left.push_back(open[j]);
    open = left;
  }
  if (!open.empty())
    outcome.status = DualOutcome::Status::limit;
  return outcome;
}

} // namespace epafi::linear
