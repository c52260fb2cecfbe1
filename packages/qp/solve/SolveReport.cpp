#include "epafi/qp/solve/SolveReport.hpp"

#include <algorithm>
#include <iterator>

namespace epafi::qp {

namespace {

struct Words {
  Status status;
  const char *name, *meaning;
};

constexpr Words words[] = {
    {Status::converged, "Converged", "the tolerance is reached, confirmed by a gradient computed afresh"},
    {Status::maxIterations, "MaxIterations",
     "the limit of operator products was reached before the tolerance; raise 'Maximum Multiplications' or "
     "the tolerance"},
    {Status::timeLimit, "TimeLimit",
     "the time limit was reached before the tolerance; raise 'Time Limit' or the tolerance"},
    {Status::interrupted, "Interrupted",
     "the iteration was asked to stop before the tolerance was reached; it can go on from its last iterate"},
    {Status::stagnated, "Stagnated",
     "round-off allows no smaller residual (attainable accuracy reached); raise the tolerance"},
    {Status::indefiniteOperator, "IndefiniteOperator",
     "a direction of negative curvature was met: the operator is not positive definite"},
    {Status::indefinitePreconditioner, "IndefinitePreconditioner",
     "the preconditioner is not positive definite: rᵀMr ≤ 0 for a residual r on the free set"},
    {Status::infeasible, "Infeasible", "the constraints contradict each other"},
    {Status::unbounded, "Unbounded",
     "the objective falls without end along a direction of zero curvature that no constraint stops"},
    {Status::notUnique, "NotUnique", "the solution is not unique"},
    {Status::notFinite, "NotFinite", "the operator returned NaN or infinity"},
};

const Words& wordsOf(Status status) {
  return *std::find_if(std::begin(words), std::end(words),
                       [&](const Words& entry) { return entry.status == status; });
}

} // namespace

std::string toString(Status status) {
  return wordsOf(status).name;
}

std::string explain(Status status) {
  return wordsOf(status).meaning;
}

void append(const SolveReport& further, SolveReport& report) {
  StepCounts& counts = report.counts;
  const int iterations = report.history.empty() ? 0 : report.history.back().iteration + 1;
  for (StepRecord record : further.history) {
    record.iteration += iterations;
    record.outer += counts.outer;
    record.hessianMultiplications += counts.hessianMultiplications;
    report.history.push_back(record);
  }
  for (int StepCounts::*const count :
       {&StepCounts::outer, &StepCounts::conjugateGradient, &StepCounts::expansion,
        &StepCounts::proportioning, &StepCounts::hessianMultiplications,
        &StepCounts::preconditionerApplications, &StepCounts::safeguards, &StepCounts::normCorrections,
        &StepCounts::negativeCurvatures, &StepCounts::fixedPointRounds})
    counts.*count += further.counts.*count;
}

void HistoryRecorder::step(const StepRecord& record) {
  history_.push_back(record);
  if (next_ != nullptr)
    next_->step(record);
}

void HistoryRecorder::look(const Vector& x) {
  if (next_ != nullptr)
    next_->look(x);
}

} // namespace epafi::qp
