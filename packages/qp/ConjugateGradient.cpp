#include "epafi/qp/ConjugateGradient.hpp"

#include "epafi/qp/BoundProblem.hpp"

#include <BelosLinearProblem.hpp>
#include <BelosPseudoBlockCGSolMgr.hpp>
#include <BelosStatusTest.hpp>
#include <BelosTpetraAdapter.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::qp {
namespace {

/// Counts the products with A: Belos applies it through this.
class CountingOperator final : public Operator {
public:
  explicit CountingOperator(RCP<const Operator> a) : a_(std::move(a)) {}
  [[nodiscard]] RCP<const Map> getDomainMap() const override { return a_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return a_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha, double beta) const override {
    a_->apply(x, y, mode, alpha, beta);
    ++count_;
  }
  [[nodiscard]] int count() const { return count_; }

private:
  RCP<const Operator> a_;
  mutable int count_ = 0;
};

/// A status test that never stops the iteration; it tells the observer of every step.
class ObservingTest final : public Belos::StatusTest<double, MultiVector, Operator> {
public:
  ObservingTest(Observer& observer, const CountingOperator& a, double reference)
      : observer_(observer), a_(a), reference_(reference) {}

  Belos::StatusType checkStatus(Belos::Iteration<double, MultiVector, Operator>* solver) override {
    std::vector<double> norms(1, 0.0);
    const auto residual = solver->getNativeResiduals(&norms);
    if (!residual.is_null())
      residual->norm2(Teuchos::arrayViewFromVector(norms));
    StepRecord record;
    record.iteration = solver->getNumIters();
    record.kind = record.iteration == 0 ? StepKind::start : StepKind::conjugateGradient;
    record.projectedGradient = reference_ > 0 ? norms[0] / reference_ : norms[0];
    record.hessianMultiplications = a_.count();
    observer_.step(record);
    return Belos::Failed;
  }
  [[nodiscard]] Belos::StatusType getStatus() const override { return Belos::Failed; }
  void reset() override {}
  void print(std::ostream& /*stream*/, int /*indent*/) const override {}

private:
  Observer& observer_;
  const CountingOperator& a_;
  double reference_;
};

} // namespace

SolveReport solveUnconstrained(const RCP<const Operator>& a, const RCP<const Vector>& b, const RCP<Vector>& x,
                               double tolerance, int maxMultiplications, Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  const double reference = b->norm2();
  const RCP<const CountingOperator> counting = rcp(new CountingOperator(a));
  const RCP<ObservingTest> test = rcp(new ObservingTest(recorder, *counting, reference));
  const Vector start(*x, Teuchos::Copy);

  using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
  const RCP<Problem> problem = rcp(new Problem(counting, x, b));
  problem->setProblem();
  const RCP<Teuchos::ParameterList> list = Teuchos::parameterList();
  list->set("Convergence Tolerance", std::max(tolerance, 1e-15));
  list->set("Maximum Iterations", maxMultiplications);
  list->set("Implicit Residual Scaling", "Norm of RHS");
  list->set("Residual Scaling", "Norm of RHS");
  list->set("Verbosity", static_cast<int>(Belos::Errors));
  Belos::PseudoBlockCGSolMgr<double, MultiVector, Operator> solver(problem, list);
  solver.setDebugStatusTest(test);

  try {
    if (reference > 0)
      solver.solve();
    else
      x->putScalar(0.0);
    report.status = Status::converged;
  } catch (const Belos::BelosError&) { // pᵀAp ≤ 0, or a norm that is NaN: the certificate below tells which
    report.status = Status::indefiniteOperator;
  }
  report.counts.conjugateGradient = reference > 0 ? solver.getNumIters() : 0;

  Vector residual(b->getMap()); // the certificate: b − Ax afresh
  counting->apply(*x, residual, Teuchos::NO_TRANS, 1.0, 0.0);
  const double quadratic = x->dot(residual);
  residual.update(1.0, *b, -1.0);
  const double norm = residual.norm2();
  report.relativeProjectedGradient = reference > 0 ? norm / reference : norm;
  report.objective = 0.5 * quadratic - b->dot(*x);
  report.counts.hessianMultiplications = counting->count();
  if (!std::isfinite(norm)) {
    report.status = Status::notFinite;
    x->assign(start);
  } else if (report.status == Status::converged && norm > tolerance * reference) {
    report.status =
        report.counts.conjugateGradient >= maxMultiplications ? Status::maxIterations : Status::stagnated;
  }
  report.reason = explain(report.status);
  return report;
}

} // namespace epafi::qp
