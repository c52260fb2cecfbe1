#include "epafi/qp/solve/ConjugateGradient.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/solve/BelosIteration.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <array>
#include <cmath>

namespace epafi::qp {
namespace {

/// Counts the products with A, or with the preconditioner: Belos applies it through this.
class CountingOperator final : public Operator {
public:
  explicit CountingOperator(RCP<const Operator> a) : a_(std::move(a)) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return a_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return a_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
             double beta) const override {
    a_->apply(x, y, mode, alpha, beta);
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }

private:
  RCP<const Operator> a_;
  mutable int count_ = 0;
};

/// Passes where the residual is small enough, at the limit, or where a rank's observer wants to stop; tells
/// it of every step. Belos leaves no room in its own messages for wishes: the ranks agree by one more a step.
class ObservingTest final : public BelosTest {
public:
  /// \param x           where the iterates are
  /// \param smallEnough  ‖b − Ax‖
  /// \param reference   ‖b‖
  ObservingTest(Observer& observer, const CountingOperator& a, const Vector& x, double smallEnough,
                double reference, int maxSteps)
      : observer_(observer), a_(a), x_(x), smallEnough_(smallEnough), reference_(reference),
        maxSteps_(maxSteps) {}

  Belos::StatusType checkStatus(BelosIteration* iteration) override {
    std::vector<double> norms(1, 0.0);
    iteration->getNativeResiduals(nullptr)->norm2(Teuchos::arrayViewFromVector(norms));
    StepRecord record;
    record.iteration = iteration->getNumIters();
    record.kind = record.iteration == 0 ? StepKind::start : StepKind::conjugateGradient;
    record.projectedGradient = norms[0] / reference_;
    record.hessianMultiplications = a_.count();
    observer_.step(record);
    std::array<AccurateSum, 2> wishes{AccurateSum(observer_.wantsToStop() ? 1.0 : 0.0),
                                      AccurateSum(observer_.wantsToLook() ? 1.0 : 0.0)};
    sumOverRanks(*x_.getMap()->getComm(), wishes);
    if (wishes[1].value() > 0)
      observer_.look(x_);
    isInterrupted_ = wishes[0].value() > 0;
    const bool isOver = isInterrupted_ || !(norms[0] > smallEnough_) || !std::isfinite(norms[0]) ||
                        record.iteration >= maxSteps_;
    status_ = isOver ? Belos::Passed : Belos::Failed;
    return status_;
  }
  [[nodiscard]] Belos::StatusType getStatus() const override { return status_; }
  void reset() override { status_ = Belos::Failed; }
  void print(std::ostream& /*stream*/, int /*indent*/) const override {}
  [[nodiscard]] bool isInterrupted() const { return isInterrupted_; }

private:
  Observer& observer_;
  const CountingOperator& a_;
  const Vector& x_;
  double smallEnough_, reference_;
  int maxSteps_;
  bool isInterrupted_ = false;
  Belos::StatusType status_ = Belos::Failed;
};

} // namespace

SolveReport solveUnconstrained(const RCP<const Operator>& a, const RCP<const Vector>& b, const RCP<Vector>& x,
                               double tolerance, int maxMultiplications, Observer* observer,
                               const RCP<const Operator>& preconditioner) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  const double reference = b->norm2();
  const RCP<const CountingOperator> counting = rcp(new CountingOperator(a));
  RCP<const CountingOperator> preconditioning;
  if (!preconditioner.is_null())
    preconditioning = rcp(new CountingOperator(preconditioner));
  const Vector start(*x, Teuchos::Copy);
  if (reference == 0)
    x->putScalar(0.0);
  report.status = Status::converged;
  const RCP<BelosProblem> problem = rcp(new BelosProblem(counting, x, b));
  if (!preconditioning.is_null())
    problem->setLeftPrec(preconditioning);
  const RCP<ObservingTest> test =
      rcp(new ObservingTest(recorder, *counting, *x, tolerance * reference, reference, maxMultiplications));
  if (reference > 0) {
    const BelosOutcome outcome = iterate(problem, {0}, test);
    report.counts.conjugateGradient = outcome.steps;
    if (outcome.isIndefinite)
      report.status = Status::indefiniteOperator;
  }

  Vector residual(b->getMap()); // the certificate: b − Ax afresh
  counting->apply(*x, residual, Teuchos::NO_TRANS, 1.0, 0.0);
  const double quadratic = x->dot(residual);
  residual.update(1.0, *b, -1.0);
  const double norm = residual.norm2();
  report.relativeProjectedGradient = reference > 0 ? norm / reference : norm;
  report.objective = 0.5 * quadratic - b->dot(*x);
  report.counts.hessianMultiplications = counting->count();
  report.counts.preconditionerApplications = preconditioning.is_null() ? 0 : preconditioning->count();
  if (!std::isfinite(norm)) {
    report.status = Status::notFinite;
    x->assign(start);
  } else if (report.status == Status::converged && norm > tolerance * reference) {
    report.status = test->isInterrupted()                                   ? Status::interrupted
                    : report.counts.conjugateGradient >= maxMultiplications ? Status::maxIterations
                                                                            : Status::stagnated;
  }
  report.reason = explain(report.status);
  return report;
}

} // namespace epafi::qp
