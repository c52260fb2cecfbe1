#include "epafi/qp/ConjugateGradient.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <BelosCGIter.hpp>
#include <BelosLinearProblem.hpp>
#include <BelosOutputManager.hpp>
#include <BelosStatusTestCombo.hpp>
#include <BelosStatusTestGenResNorm.hpp>
#include <BelosStatusTestMaxIters.hpp>
#include <BelosTpetraAdapter.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>
#include <Trilinos_version.h>

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

using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using Iteration = Belos::Iteration<double, MultiVector, Operator>;
using Test = Belos::StatusTest<double, MultiVector, Operator>;
using ResidualTest = Belos::StatusTestGenResNorm<double, MultiVector, Operator>;

/// A status test that tells the observer of every step, and passes if one rank's wants to stop. Belos leaves no room in its
/// own messages for that: the ranks agree by one more a step.
class ObservingTest final : public Test {
public:
  /// \param x  where the iterates are
  ObservingTest(Observer& observer, const CountingOperator& a, const Vector& x, double reference)
      : observer_(observer), a_(a), x_(x), reference_(reference) {}

  Belos::StatusType checkStatus(Iteration* iteration) override {
    std::vector<double> norms(1, 0.0);
    const auto residual = iteration->getNativeResiduals(&norms);
    if (!residual.is_null())
      residual->norm2(Teuchos::arrayViewFromVector(norms));
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
    status_ = wishes[0].value() > 0 ? Belos::Passed : Belos::Failed;
    return status_;
  }
  [[nodiscard]] Belos::StatusType getStatus() const override { return status_; }
  void reset() override { status_ = Belos::Failed; }
  void print(std::ostream& /*stream*/, int /*indent*/) const override {}

private:
  Observer& observer_;
  const CountingOperator& a_;
  const Vector& x_;
  double reference_;
  Belos::StatusType status_ = Belos::Failed;
};

/// Belos's CG iteration from the problem's present solution. Returns the number of steps.
int iterate(const RCP<Problem>& problem, double tolerance, int maxSteps, const RCP<Test>& observing) {
  const RCP<ResidualTest> converged = rcp(new ResidualTest(tolerance, 1));
  converged->defineScaleForm(Belos::NormOfRHS, Belos::TwoNorm);
  const RCP<Test> limit = rcp(new Belos::StatusTestMaxIters<double, MultiVector, Operator>(maxSteps));
  using Combo = Belos::StatusTestCombo<double, MultiVector, Operator>;
  const RCP<Combo> stop = rcp(new Combo(Combo::OR, observing, Teuchos::rcp_implicit_cast<Test>(converged)));
  stop->addStatusTest(limit);
  const auto printer = rcp(new Belos::OutputManager<double>(Belos::Errors));
  Teuchos::ParameterList parameters;
  Belos::CGIter<double, MultiVector, Operator> iteration(problem, printer, stop, converged, parameters);

  problem->setLSIndex({0});
  const RCP<MultiVector> residual = rcp(new MultiVector(*problem->getInitResVec(), Teuchos::Copy));
#if TRILINOS_MAJOR_MINOR_VERSION >= 160000
  iteration.initializeCG(rcp(new Belos::CGIterationState<double, MultiVector>(residual)), residual);
#else
  Belos::CGIterationState<double, MultiVector> state;
  state.R = residual;
  iteration.initializeCG(state);
#endif
  iteration.iterate();
  return iteration.getNumIters();
}

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
  bool isInterrupted = false;
  try {
    const RCP<Problem> problem = rcp(new Problem(counting, x, b));
    if (!preconditioning.is_null())
      problem->setLeftPrec(preconditioning);
    problem->setProblem();
    const RCP<Test> observing = rcp(new ObservingTest(recorder, *counting, *x, reference));
    if (reference > 0)
      report.counts.conjugateGradient = iterate(problem, tolerance, maxMultiplications, observing);
    isInterrupted = observing->getStatus() == Belos::Passed;
  } catch (const Belos::BelosError&) { // pᵀAp ≤ 0, or a norm that is NaN: the certificate below tells which
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
    report.status = isInterrupted                                           ? Status::interrupted
                    : report.counts.conjugateGradient >= maxMultiplications ? Status::maxIterations
                                                                            : Status::stagnated;
  }
  report.reason = explain(report.status);
  return report;
}

} // namespace epafi::qp
