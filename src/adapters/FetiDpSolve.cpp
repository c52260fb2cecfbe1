#include "epafi/adapters/FetiDpSolve.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_ParameterList.hpp>
#include <Thyra_LinearOpWithSolveBase.hpp>
#include <Thyra_MultiVectorBase.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_MultiVector.hpp>

#include <sstream>

namespace epafi::adapters {
namespace {

using Extraction =
    Thyra::TpetraOperatorVectorExtraction<double, LocalOrdinal, GlobalOrdinal, MultiVector::node_type>;

bool isByStart(const Thyra::SolveMeasureType& measure) {
  return measure(Thyra::SOLVE_MEASURE_NORM_RESIDUAL, Thyra::SOLVE_MEASURE_NORM_INIT_RESIDUAL);
}

bool isByRightHandSide(const Thyra::SolveMeasureType& measure) {
  return measure.useDefault() || measure(Thyra::SOLVE_MEASURE_NORM_RESIDUAL, Thyra::SOLVE_MEASURE_NORM_RHS);
}

} // namespace

void FetiDpSolve::initialize(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                             const linear::FetiDpParameters& parameters) {
  const std::shared_ptr<linear::FetiDpSolver> previous = solver_;
  uninitialize(); // should this fail, there is none
  const ForwardOperator forward = forwardOperator(*source);
  if (forward.k.is_null())
    throw InputError("FETI-DP cannot solve with the operator " + source->getOp()->description() +
                     "; it must be epafi::adapters::asThyra of an epafi::linear::UnassembledOperator");
  if (forward.factor == 0)
    throw InputError("FETI-DP cannot solve with an operator times zero");
  if (previous && previous->forwardOperator() == forward.k && previous->parameters() == parameters) {
    previous->update();
    solver_ = previous;
  } else {
    solver_ = std::make_shared<linear::FetiDpSolver>(forward.k, parameters);
  }
  forward_ = forward;
  source_ = source;
}

RCP<const Thyra::LinearOpSourceBase<double>> FetiDpSolve::uninitialize() {
  const auto source = source_;
  source_ = Teuchos::null;
  solver_.reset();
  forward_ = {};
  return source;
}

RCP<const Thyra::VectorSpaceBase<double>> FetiDpSolve::range() const {
  return source_.is_null() ? Teuchos::null : source_->getOp()->range();
}

RCP<const Thyra::VectorSpaceBase<double>> FetiDpSolve::domain() const {
  return source_.is_null() ? Teuchos::null : source_->getOp()->domain();
}

std::string FetiDpSolve::description() const {
  return source_.is_null() ? "epafi::adapters::FetiDpSolve{not initialized}"
                           : "epafi::adapters::FetiDpSolve{" + source_->getOp()->description() + "}";
}

bool FetiDpSolve::opSupportedImpl(Thyra::EOpTransp transposition) const {
  return !source_.is_null() && Thyra::opSupported(*source_->getOp(), transposition);
}

void FetiDpSolve::applyImpl(Thyra::EOpTransp transposition, const Thyra::MultiVectorBase<double>& x,
                            const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& y, double alpha,
                            double beta) const {
  Thyra::apply(*source_->getOp(), transposition, x, y, alpha, beta);
}

bool FetiDpSolve::solveSupportsImpl(Thyra::EOpTransp /*transposition*/) const {
  return true;
}

bool FetiDpSolve::solveSupportsNewImpl(Thyra::EOpTransp transposition,
                                       Teuchos::Ptr<const Thyra::SolveCriteria<double>> criteria) const {
  return criteria.is_null() ||
         (criteria->numeratorReductionFunc.is_null() && criteria->denominatorReductionFunc.is_null() &&
          solveSupportsSolveMeasureTypeImpl(transposition, criteria->solveMeasureType));
}

bool FetiDpSolve::solveSupportsSolveMeasureTypeImpl(Thyra::EOpTransp /*transposition*/,
                                                    const Thyra::SolveMeasureType& measure) const {
  return isByRightHandSide(measure) || isByStart(measure);
}

Thyra::SolveStatus<double>
FetiDpSolve::solveImpl(Thyra::EOpTransp transposition, const Thyra::MultiVectorBase<double>& b,
                       const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& x,
                       Teuchos::Ptr<const Thyra::SolveCriteria<double>> criteria) const {
  if (!solver_)
    throw Error("a FETI-DP operator was asked to solve before it was initialised; call initializeOp first");
  if (!solveSupportsNewImpl(transposition, criteria)) {
    std::ostringstream measure;
    measure << criteria->solveMeasureType;
    throw InputError("FETI-DP cannot stop by the measure " + measure.str() +
                     "; ask for the norm of the residual relative to that of the right-hand side or of the "
                     "start residual, without reduction functionals");
  }
  const bool hasTolerance =
      !criteria.is_null() && criteria->requestedTol != Thyra::SolveCriteria<double>::unspecifiedTolerance();
  const double tolerance = hasTolerance ? criteria->requestedTol : solver_->parameters().tolerance;
  const auto reference = !criteria.is_null() && isByStart(criteria->solveMeasureType)
                             ? linear::ResidualReference::startResidual
                             : linear::ResidualReference::rightHandSide;
  const RCP<const MultiVector> rhs = Extraction::getConstTpetraMultiVector(Teuchos::rcpFromRef(b));
  const RCP<MultiVector> solution = Extraction::getTpetraMultiVector(Teuchos::rcpFromPtr(x));

  linear::LinearReport report;
  if (forward_.factor == 1) {
    report = solver_->solve(*rhs, *solution, tolerance, reference);
  } else { // a K x = b
    MultiVector scaled(*rhs, Teuchos::Copy);
    scaled.scale(1 / forward_.factor);
    report = solver_->solve(scaled, *solution, tolerance, reference);
  }
  Thyra::SolveStatus<double> status;
  status.solveStatus = report.converged ? Thyra::SOLVE_STATUS_CONVERGED : Thyra::SOLVE_STATUS_UNCONVERGED;
  status.achievedTol = report.largestResidual();
  status.message = report.reason;
  status.extraParameters = Teuchos::parameterList();
  status.extraParameters->set("Iteration Count", report.iterations);
  return status;
}

} // namespace epafi::adapters
