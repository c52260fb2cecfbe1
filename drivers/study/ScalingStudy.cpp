#include "ScalingCase.hpp"
#include "ScalingReport.hpp"
#include "Studies.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>

namespace epafi::drivers {
namespace {

/// After how many products dense blocks have paid off beside the implicit run with the same preconditioner,
/// or, where there is none, with the default one.
double payoffIn(const Table& table, const Row& row) {
  Row like = row;
  like["operator"] = "implicit";
  const Row* implicitRun = table.find(like, scalingSettings);
  if (implicitRun == nullptr) {
    like["preconditioner"] = "dirichlet";
    like["precision"] = "double";
    implicitRun = table.find(like, scalingSettings);
  }
  if (row.text("operator") == "implicit" || implicitRun == nullptr)
    return notMeasured;
  return payoffOf({implicitRun->number("apply_seconds"), row.number("apply_seconds"),
                   row.number("explicit_setup_seconds")});
}

/// Makes the runs and adds them to the table. Returns whether all converged. Collective.
bool measureRuns(const std::vector<Row>& runs, double streamRate, const RCP<const Comm>& comm, Table& table) {
  bool converged = true;
  Table measured = scalingTable();
  for (Row row : runs) {
    converged = measureRun(row, comm) && converged;
    row["stream_bytes_per_second"] = streamRate;
    measured.rows.push_back(row);
    tell(*comm, row.text("problem") + ", 1/H = " + plain(row.number("H_inverse")) +
                    ", H/h = " + plain(row.number("H_over_h")) + ", " + row.text("operator") + ", " +
                    row.text("preconditioner") + ' ' + row.text("precision") + ": " +
                    plain(row.number("hessian_multiplications")) + " products, " +
                    plain(row.number("total_seconds")) + " s");
  }
  for (Row row : measured.rows) {
    row["payoff_products"] = payoffIn(measured, row);
    table.rows.push_back(row);
  }
  // Rows of few ranks first.
  std::stable_sort(table.rows.begin(), table.rows.end(),
                   [](const Row& a, const Row& b) { return a.number("ranks") < b.number("ranks"); });
  return converged;
}

/// Tables that one rank makes alone, and their files.
std::string measureParts(const std::filesystem::path& directory, const ScalingSizes& sizes, double streamRate,
                         const Table& table, const Comm& comm) {
  const Table products = timeBlockProducts(sizes.blockBytes, streamRate);
  std::vector<int> costSizes = sizes.allCombinations;
  costSizes.insert(costSizes.end(), sizes.someCombinations.begin(), sizes.someCombinations.end());
  const Table costs = timeDualCosts(sizes.fixedSubdomains, costSizes);
  Row membranes = scalingRun("coercive", sizes.fixedSubdomains, sizes.elements.back()),
      blocks = scalingRun("blocks", sizes.blocks, sizes.blocksElements);
  membranes["operator"] = "explicit"; // one of the combinations
  blocks["operator"] = "implicit";    // one of the methods
  Table coarse = timeCoarseProblems("coercive", sizes.coarse), steps = predictedTable();
  const Table ofBlocks = timeCoarseProblems("blocks", sizes.coarseBlocks);
  coarse.rows.insert(coarse.rows.end(), ofBlocks.rows.begin(), ofBlocks.rows.end());
  for (const Row& like : {membranes, blocks}) {
    const Table more = predictSteps(LocalWork::of(*table.find(like, scalingSettings)), coarse, {1, 16, 64});
    steps.rows.insert(steps.rows.end(), more.rows.begin(), more.rows.end());
  }
  writeFiles(directory,
             {{"scaling_blocks.csv", products.csv()},
              {"scaling_costs.csv", costs.csv()},
              {"scaling_coarse.csv", coarse.csv()},
              {"scaling_prediction.csv", steps.csv()}},
             comm);
  return blockReport(products, streamRate) + costReport(costs) + predictionReport(steps);
}

} // namespace

bool studyScaling(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  const ScalingSizes sizes(quick);
  const int ranks = comm->getSize();
  Table table = scalingTable();
  collectively(*comm, [&] {
    if (comm->getRank() == 0)
      table = readScaling(directory / "scaling.csv", ranks);
  });
  const double streamRate = streamBandwidth(*comm, sizes.streamBytes);
  const bool converged =
      measureRuns(ranks == 1 ? runsOnOneRank(sizes) : runsOnRanks(sizes, ranks), streamRate, comm, table);
  std::string report = scalingReport(table, sizes);
  if (ranks == 1)
    report += measureParts(directory, sizes, streamRate, table, *comm);
  tell(*comm, report);
  writeFiles(directory, {{"scaling.csv", table.csv()}, {"scaling.md", report}}, *comm);
  return converged;
}

} // namespace epafi::drivers
