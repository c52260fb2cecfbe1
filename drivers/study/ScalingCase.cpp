#include "ScalingCase.hpp"

#include "Median.hpp"
#include "MessageCounts.hpp"
#include "ScalingScene.hpp"
#include "epafi/base/PeakMemory.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/fetidp/precondition/DualPreconditioner.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <set>
#include <vector>

namespace epafi::drivers {
namespace {

constexpr std::size_t mostRuns = 7;
constexpr double secondsOfRuns = 5; ///< after which there is no further run
constexpr double secondsOfProducts = 0.1;

Teuchos::ParameterList parametersOf(const Row& run) {
  const std::string& dualOperator = run.text("operator");
  Teuchos::ParameterList parameters;
  parameters.sublist("Dual Operator").set("Mode", dualOperator == "implicit" ? "implicit" : "explicit");
  parameters.sublist("Direct Solvers")
      .set("Share Identical Subdomains", dualOperator == "shared" ? "yes" : "no");
  parameters.sublist("Preconditioner")
      .set("Type", run.text("preconditioner"))
      .set("Precision", run.text("precision"));
  return parameters;
}

/// Reductions that conjugate gradient steps make, products included.
class ReductionCount final : public simulation::RunCompanion {
public:
  void step(const qp::StepRecord& record) override {
    const MessageCounts now = messageCounts(), ofStep = now - last_;
    if (record.kind == qp::StepKind::conjugateGradient) {
      number_.push_back(static_cast<double>(ofStep.reductions));
      bytes_.push_back(static_cast<double>(ofStep.reductionBytes));
      inTeams_.push_back(static_cast<double>(ofStep.teamReductions));
      gatherings_.push_back(static_cast<double>(ofStep.gatherings));
    }
    last_ = now;
  }
  void addTo(Row& row) const {
    row["reductions_per_step"] = number_.empty() ? notMeasured : median(number_);
    row["reduction_bytes_per_step"] = bytes_.empty() ? notMeasured : median(bytes_);
    row["team_reductions_per_step"] = inTeams_.empty() ? notMeasured : median(inTeams_);
    row["gatherings_per_step"] = gatherings_.empty() ? notMeasured : median(gatherings_);
  }

private:
  MessageCounts last_;
  std::vector<double> number_, bytes_, inTeams_, gatherings_;
};

/// Times of one run after the other.
struct RunTimes {
  std::vector<double> assembly, setup, solve, total;
  double sum = 0;

  void add(const simulation::RunResult& result) {
    assembly.push_back(result.times.assembly);
    setup.push_back(result.solve.times.setup);
    solve.push_back(result.solve.times.solve);
    total.push_back(assembly.back() + setup.back() + solve.back() + result.times.recovery);
    sum += total.back();
  }
};

void measureProducts(const fetidp::DualProblem& dual, const Comm& comm, Row& row) {
  const fetidp::DualOperator& f = *dual.dualOperator();
  Vector x(f.getDomainMap()), y(f.getDomainMap());
  x.putScalar(1.0);
  row["apply_seconds"] = medianSeconds(comm, secondsOfProducts, [&] { f.apply(x, y); });
  const MessageCounts before = messageCounts();
  f.apply(x, y);
  const MessageCounts sent = messageCounts() - before;
  row["messages_per_apply"] = maxOverRanks(comm, static_cast<double>(sent.messages));
  row["bytes_sent_per_apply"] = maxOverRanks(comm, static_cast<double>(sent.bytes));
  row["reduction_bytes_per_apply"] = maxOverRanks(comm, static_cast<double>(sent.reductionBytes));
  if (dual.preconditioner().is_null())
    return;
  row["preconditioner_seconds"] =
      medianSeconds(comm, secondsOfProducts, [&] { dual.preconditioner()->apply(x, y); });
  if (const auto m = Teuchos::rcp_dynamic_cast<const fetidp::DualPreconditioner>(dual.preconditioner());
      !m.is_null())
    row["preconditioner_bytes"] = sumOverRanks(comm, static_cast<double>(m->bytes()));
}

/// What the blocks of F read, hold and took to make.
void measureBlocks(const fetidp::GeneralizedInverse& inverse, const Comm& comm, Row& row) {
  double bytes = 0;
  for (const fetidp::SubdomainGroup& group : inverse.groups())
    bytes += static_cast<double>(group.applyBytes());
  row["apply_bytes"] = sumOverRanks(comm, bytes);
  row["factor_bytes"] = sumOverRanks(comm, static_cast<double>(inverse.factorBytes()));
  row["coarse_unknowns"] = inverse.coarseProblem().size();
  if (row.text("operator") == "implicit")
    return;
  const double begin = Teuchos::Time::wallTime();
  for (const fetidp::SubdomainGroup& group : inverse.groups())
    const direct::SymmetricBlock block(group.condensed().factor().inverseOfKept(), group.use());
  row["explicit_setup_seconds"] = maxOverRanks(comm, Teuchos::Time::wallTime() - begin);
}

/// Of the subdomain matrices, each different one once.
double matrixBytes(const decomposition::DecomposedProblem& problem) {
  std::set<const decomposition::SparseMatrix*> different;
  for (const auto& subdomain : problem.subdomains)
    different.insert(subdomain.stiffness.get());
  double bytes = 0;
  for (const decomposition::SparseMatrix* matrix : different)
    bytes += static_cast<double>(matrix->nonZeros()) * (sizeof(double) + sizeof(int));
  return sumOverRanks(*problem.comm, bytes);
}

/// Of the vectors without which a scene is not solved: load, prescribed values, displacement, nodes of every
/// subdomain; λ, d̃, g, p, Fp, φ, Mφ, bound, gap, slack, active set, work of F.
double vectorBytes(const decomposition::DecomposedProblem& problem) {
  return sizeof(double) * (4.0 * static_cast<double>(problem.primalDimension) +
                           12.0 * static_cast<double>(problem.dualDimension()));
}

/// One run from the scene to the solution. Returns whether it converged.
bool runOnce(const scene::Scene& scene, bool measuresProducts, const RCP<const Comm>& comm, RunTimes& times,
             Row& row) {
  row["base_bytes"] = sumOverRanks(*comm, resetPeakBytes());
  ReductionCount reductions;
  const simulation::SceneRun run =
      simulation::solveScene(scene, parametersOf(row), comm, {.companion = &reductions});
  row["peak_bytes"] = sumOverRanks(*comm, peakBytes());
  times.add(run.result);
  row["hessian_multiplications"] = run.solver->report().counts.hessianMultiplications;
  row["energy"] = run.solution.energy;
  reductions.addTo(row);
  const decomposition::DecomposedProblem& problem = run.decomposition->problem;
  row["unknowns"] = static_cast<double>(problem.primalDimension);
  row["multipliers"] = static_cast<double>(problem.dualDimension());
  row["problem_bytes"] = matrixBytes(problem) + vectorBytes(problem);
  row["preconditioner_bytes"] =
      sumOverRanks(*comm, static_cast<double>(run.solver->dualProblem().preconditionerBytes()));
  if (measuresProducts) {
    measureProducts(run.solver->dualProblem(), *comm, row);
    measureBlocks(run.solver->dualProblem().dualOperator()->inverse(), *comm, row);
  }
  return run.solver->report().status == qp::Status::converged;
}

} // namespace

bool measureRun(Row& row, const RCP<const Comm>& comm) {
  scene::Scene scene = scalingScene(row.text("problem"), static_cast<int>(row.number("H_inverse")),
                                    static_cast<int>(row.number("H_over_h")));
  for (scene::Body& body : scene.bodies)
    body.decomposition.cluster = static_cast<int>(row.number("cluster"));
  row["ranks"] = comm->getSize();
  RunTimes times;
  bool converged = true;
  while (times.total.empty() || (times.total.size() < mostRuns && times.sum < secondsOfRuns))
    converged = runOnce(scene, times.total.empty(), comm, times, row) && converged;
  row["assembly_seconds"] = median(times.assembly);
  row["setup_seconds"] = median(times.setup);
  row["solve_seconds"] = median(times.solve);
  row["total_seconds"] = median(times.total);
  return converged;
}

} // namespace epafi::drivers
