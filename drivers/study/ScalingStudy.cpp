#include "ScalingStudy.hpp"

#include "ScalingCase.hpp"
#include "ScalingReport.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>

#include <iostream>

namespace epafi::drivers {
namespace {

void write(const std::filesystem::path& file, const std::string& text, const Comm& comm) {
  output::writeTextFile(
      file, [&] { return text; }, comm);
}

/// After how many products dense blocks have paid off beside the implicit run with the same preconditioner, or, where
/// there is none, with the default one.
double payoffOf(const ScalingRow& row, const ScalingTable& table) {
  ScalingRow like = row;
  like.dualOperator = "implicit";
  const ScalingRow* implicitRun = table.find(like);
  if (implicitRun == nullptr) {
    like.preconditioner = "dirichlet";
    like.precision = "double";
    implicitRun = table.find(like);
  }
  if (row.dualOperator == "implicit" || implicitRun == nullptr)
    return ScalingRow::unknown;
  return DualCostTimes::payoff({implicitRun->applySeconds, row.applySeconds, row.explicitSetup});
}

/// Makes the runs and adds them to the table. Returns whether all converged. Collective.
bool measureRuns(const std::vector<ScalingRow>& runs, double streamRate, const RCP<const Comm>& comm,
                 ScalingTable& table) {
  bool converged = true;
  ScalingTable measured;
  for (ScalingRow row : runs) {
    converged = measureRun(row, comm) && converged;
    row.streamRate = streamRate;
    measured.add(row);
    if (comm->getRank() == 0)
      std::cout << row.problem << ", 1/H = " << row.subdomainsPerSide << ", H/h = " << row.elementsPerSide
                << ", " << row.dualOperator << ", " << row.preconditioner << ' ' << row.precision << ": "
                << row.hessianMultiplications << " products, " << row.total << " s" << std::endl;
  }
  for (ScalingRow row : measured.rows()) {
    row.payoffProducts = payoffOf(row, measured);
    table.add(row);
  }
  return converged;
}

/// Tables that one rank makes alone, and their files.
std::string measureParts(const std::filesystem::path& directory, const ScalingSizes& sizes, double streamRate,
                         const ScalingTable& table, const Comm& comm) {
  const std::vector<BlockProduct> products = timeBlockProducts(sizes.blockBytes);
  std::vector<int> costSizes = sizes.allCombinations;
  costSizes.insert(costSizes.end(), sizes.someCombinations.begin(), sizes.someCombinations.end());
  const std::vector<DualCostTimes> costs = timeDualCosts(sizes.fixedSubdomains, costSizes);
  const std::vector<CoarseTimes> coarse = timeCoarseProblems(sizes.coarse);
  ScalingRow like;
  like.subdomainsPerSide = sizes.fixedSubdomains;
  like.elementsPerSide = sizes.elements.back();
  like.dualOperator = "explicit";
  like = *table.find(like); // one of the combinations
  const std::vector<PredictedStep> steps = predictSteps(like, coarse, {1, 16, 64});
  write(directory / "scaling_blocks.csv", blocksCsv(products, streamRate), comm);
  write(directory / "scaling_costs.csv", costsCsv(costs), comm);
  write(directory / "scaling_coarse.csv", coarseCsv(coarse), comm);
  write(directory / "scaling_prediction.csv", predictionCsv(steps), comm);
  return blockReport(products, streamRate) + costReport(costs) + predictionReport(steps, like);
}

} // namespace

bool studyScaling(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  const ScalingSizes sizes(quick);
  const int ranks = comm->getSize();
  ScalingTable table;
  collectively(*comm, [&] {
    if (comm->getRank() == 0)
      table = ScalingTable(directory / "scaling.csv");
  });
  table.removeRanks(ranks);
  const double streamRate = streamBandwidth(*comm, sizes.streamBytes);
  const bool converged =
      measureRuns(ranks == 1 ? runsOnOneRank(sizes) : runsOnRanks(sizes, ranks), streamRate, comm, table);
  std::string report =
      growthReport(table, sizes) + combinationReport(table, sizes) + ranksReport(table, sizes);
  if (ranks == 1)
    report += measureParts(directory, sizes, streamRate, table, *comm);
  write(directory / "scaling.csv", table.csv(), *comm);
  write(directory / "scaling.md", report, *comm);
  if (comm->getRank() == 0)
    std::cout << report << "\nwritten: " << (directory / "scaling.csv").string() << " and "
              << (directory / "scaling.md").string() << '\n';
  return converged;
}

} // namespace epafi::drivers
