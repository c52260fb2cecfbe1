#include "epafi/qp/solve/QpSolver.hpp"

#include "epafi/base/Parameters.hpp"
#include "epafi/qp/solve/QpRun.hpp"

#include <Teuchos_TimeMonitor.hpp>

#include <sstream>
#include <vector>

namespace epafi::qp {
namespace {

const std::vector<std::string> algorithms{"auto", "MPRGP", "active set"};

} // namespace

Teuchos::ParameterList QpSolver::validParameters() {
  Teuchos::ParameterList list("QP");
  addReal(list, "Tolerance", 1e-6, "Stop at ‖gᴾ‖ ≤ Tolerance · Reference.", 0.0, 1.0);
  addReal(list, "Absolute Tolerance", 0.0, "Stop at ‖gᴾ‖ ≤ this as well; 0 leaves the relative test alone.",
          0.0);
  addReal(list, "Reference", 0.0,
          "What ‖gᴾ‖ is relative to; 0 stands for ‖b‖ (or, where b is round-off beside ‖A‖‖y‖ for the "
          "feasible point y nearest to 0, for ‖Ay‖).",
          0.0);
  addChoice(
      list, "Algorithm", algorithms.front(),
      "'MPRGP', with SMALBE around it where there are equations; 'active set', primal–dual active sets, "
      "after which MPRGP goes on where their faces do not settle, and with more than 'Maximum Dense Rows' "
      "equations; 'auto', active sets with discs, else MPRGP.",
      algorithms);
  addReal(list, "Constraint Tolerance", 1e-6,
          "Stop only if ‖Bx − c‖ ≤ this times ‖c‖ (or, if c = 0, ‖B‖‖b‖/‖A‖) as well.", 0.0, 1.0, true);
  addInteger(list, "Maximum Dense Rows", 300,
             "Up to so many rows of B are made orthonormal, and redundant ones found, with a dense matrix of "
             "that size on every rank; beyond, B is only scaled.",
             0);
  addReal(list, "Operator Norm", 0.0,
          "An over-estimate of ‖A‖ if one is known; 0 for an estimate by 'Norm Estimate'.", 0.0);
  list.sublist("MPRGP").setParameters(MprgpParameters::validParameters());
  list.sublist("SMALBE").setParameters(SmalbeParameters::validParameters());
  list.sublist("Norm Estimate").setParameters(NormEstimateParameters::validParameters());
  return list;
}

QpSolver::QpSolver(const Teuchos::ParameterList& parameters) {
  const Teuchos::ParameterList list = validated(parameters, validParameters(), "");
  tolerance_ = list.get<double>("Tolerance");
  absoluteTolerance_ = list.get<double>("Absolute Tolerance");
  reference_ = list.get<double>("Reference");
  constraintTolerance_ = list.get<double>("Constraint Tolerance");
  maxDenseRows_ = list.get<int>("Maximum Dense Rows");
  operatorNorm_ = list.get<double>("Operator Norm");
  if (const auto& name = list.get<std::string>("Algorithm"); name != "auto")
    method_ = name == "MPRGP" ? Method::mprgp : Method::activeSets;
  methods_.mprgp = MprgpParameters::from(list.sublist("MPRGP"));
  methods_.smalbe = SmalbeParameters::from(list.sublist("SMALBE"));
  norm_ = NormEstimateParameters::from(list.sublist("Norm Estimate"));
}

std::string QpSolver::description() const {
  std::ostringstream text;
  text << "Epafi::qp::QpSolver {tolerance: " << tolerance_ << ", last run: " << lastRun_ << "}";
  return text.str();
}

QpSolution QpSolver::solve(const QuadraticProgram& problem, Vector& x, Observer* observer) {
  const Teuchos::TimeMonitor timing(*Teuchos::TimeMonitor::getNewCounter("Epafi::qp: QpSolver::solve"));
  QpSolution solution;
  Run run{*this, problem, x, observer, solution, problem};
  run.check();
  if (run.prepareConstraints() && run.findStart() && run.prepareOperators()) {
    run.iterate();
    run.lookForUnboundedness();
    run.certify();
  }
  lastRun_ = toString(solution.report.status);
  lastRun_.append(", ")
      .append(std::to_string(solution.report.counts.hessianMultiplications))
      .append(" products");
  return solution;
}

} // namespace epafi::qp
