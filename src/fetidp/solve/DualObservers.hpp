#pragma once

/// Who looks at the iterates of a dual solve: an error's target, and whoever is shown λ.

#include "epafi/fetidp/solve/DualProblem.hpp"
#include "epafi/fetidp/solve/Recovery.hpp"
#include "epafi/qp/solve/ErrorTarget.hpp"

#include <Tpetra_Vector.hpp>

#include <functional>
#include <utility>

namespace epafi::fetidp {

/// A fraction of the discretisation error η, of the displacements that go with an iterate. An algebraic error
/// e blurs η by no more than about its own size: a look with e ≤ η/2 is enough.
class BalancedTarget final : public qp::ErrorTarget {
public:
  /// Keeps references. \param complete  makes λ of an iterate
  BalancedTarget(const DualProblem& dual, const decomposition::ProblemData& data, const ErrorBalance& balance,
                 std::function<void(Vector&)> complete)
      : dual_(dual), data_(data), balance_(balance), fraction_(dual.plan().algebraicFraction),
        complete_(std::move(complete)), lookedAt_(dual.problem().multiplierMap) {}

  double first(double error) override {
    return balance_.expected > 0 ? fraction_ * balance_.expected : balance_.firstLook * error;
  }
  double at(double error, const Vector& x) override {
    if (isClear_)
      return last_;
    lookedAt_.assign(x);
    complete_(lookedAt_);
    const double mesh = balance_.estimate(displacementOf(dual_, data_, lookedAt_));
    isClear_ = error <= 0.5 * mesh;
    last_ = fraction_ * (isClear_ && error > fraction_ * mesh ? mesh - error : mesh);
    return last_;
  }
  [[nodiscard]] double last() const { return last_; }
  /// Whether the last look was at this λ, but for round-off. Collective.
  [[nodiscard]] bool hasSeen(const Vector& lambda) const {
    Vector difference(lambda, Teuchos::Copy);
    difference.update(-1.0, lookedAt_, 1.0);
    return last_ > 0 && difference.normInf() <= 1e-9 * lambda.normInf();
  }

private:
  const DualProblem& dual_;
  const decomposition::ProblemData& data_;
  const ErrorBalance& balance_;
  const double fraction_;
  std::function<void(Vector&)> complete_;
  Vector lookedAt_; ///< λ
  double last_ = 0;
  bool isClear_ = false;
};

/// Shows λ where the iteration has μ = λ − λ̃.
class ShiftedObserver final : public qp::Observer {
public:
  /// \param shift  λ̃
  ShiftedObserver(qp::Observer& next, const Vector& shift)
      : next_(next), shift_(shift), sum_(shift.getMap()) {}
  void step(const qp::StepRecord& record) override { next_.step(record); }
  [[nodiscard]] bool wantsToStop() override { return next_.wantsToStop(); }
  [[nodiscard]] bool wantsToLook() override { return next_.wantsToLook(); }
  void look(const Vector& mu) override {
    sum_.update(1.0, mu, 1.0, shift_, 0.0);
    next_.look(sum_);
  }

private:
  qp::Observer& next_;
  const Vector& shift_;
  Vector sum_;
};

} // namespace epafi::fetidp
