#include "StabilityCase.hpp"
#include "Studies.hpp"
#include "Table.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace epafi::drivers {
namespace {

Row rowOf(const StabilityCase& trial, const CaseResult& result) {
  return {{"case", trial.name},
          {"parameter", trial.parameter},
          {"expected", toString(trial.expected)},
          {"outcome", toString(result.outcome)},
          {"ok", isAsExpected(trial.expected, result)},
          {"hessian_multiplications", result.products},
          {"family", trial.family},
          {"value", trial.value},
          {"variant", trial.variant},
          {"ranks", std::max(trial.ranks, 1)},
          {"status", result.status},
          {"relative_projected_gradient", result.projectedGradient},
          {"balance", result.balance},
          {"penetration", result.penetration},
          {"complementarity", result.complementarity},
          {"energy_norm_error", result.energyError},
          {"norm_multiplications", result.normProducts},
          {"active_contact_nodes", result.active < 0 ? Row::Value() : Row::Value(result.active)},
          {"seconds", result.seconds},
          {"reason", result.reason}};
}

/// What the cases of one family or one name came to.
struct Tally {
  int total = 0, solved = 0, refused = 0, stopped = 0, unexpected = 0;
  int leastProducts = 0, mostProducts = 0; ///< of those solved

  void add(const StabilityCase& trial, const CaseResult& result) {
    ++total;
    if (result.outcome == Outcome::solved) {
      leastProducts = solved == 0 ? result.products : std::min(leastProducts, result.products);
      mostProducts = std::max(mostProducts, result.products);
      ++solved;
    }
    refused += result.outcome == Outcome::noSolution || result.outcome == Outcome::notUnique ||
               result.outcome == Outcome::wrongInput;
    stopped += result.outcome == Outcome::stopped;
    const bool asExpected = isAsExpected(trial.expected, result);
    unexpected += asExpected ? 0 : 1;
  }
};

/// One line a case and variant, all parameters together, in the order of the cases.
class Summary {
public:
  void add(const StabilityCase& trial, const CaseResult& result) {
    const std::string key = "| " + trial.family + " | " + trial.name + " | " + trial.variant + " | ";
    if (tallies_.count(key) == 0)
      order_.push_back(key);
    tallies_[key].add(trial, result);
    all_.add(trial, result);
  }
  [[nodiscard]] const Tally& all() const { return all_; }
  [[nodiscard]] std::string markdown() const {
    std::string text = markdownHeading("family | case | variant | rows | solved | refused | stopped | not as "
                                       "expected | products, if solved");
    for (const std::string& key : order_) {
      const Tally& tally = tallies_.at(key);
      text += key;
      for (const int number : {tally.total, tally.solved, tally.refused, tally.stopped, tally.unexpected})
        text.append(std::to_string(number)).append(" | ");
      if (tally.solved > 0)
        text.append(std::to_string(tally.leastProducts))
            .append(" … ")
            .append(std::to_string(tally.mostProducts));
      text += " |\n";
    }
    return text;
  }

private:
  std::vector<std::string> order_;
  std::map<std::string, Tally> tallies_;
  Tally all_;
};

/// Waits for all ranks without taking the processor from those that work. Collective.
void sleepTogether(const Comm& comm) {
  const MPI_Comm raw = *dynamic_cast<const Teuchos::MpiComm<int>&>(comm).getRawMpiComm();
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(raw, &request);
  for (int done = 0; done == 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE))
    if (done == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

} // namespace

bool studyStability(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm) {
  Table table(
      "case*,parameter*,expected*,outcome*,ok,hessian_multiplications,family,value,variant,ranks,status,"
      "relative_projected_gradient,balance,penetration,complementarity,energy_norm_error,norm_"
      "multiplications,"
      "active_contact_nodes,seconds,reason*");
  Summary summary;
  int leftOut = 0;
  std::map<int, RCP<const Comm>> firstRanks; // communicators of the first n ranks
  for (const StabilityCase& trial : stabilityCases("", quick)) {
    const int ranks = std::max(trial.ranks, 1);
    if (ranks > comm->getSize()) {
      ++leftOut;
      continue;
    }
    const bool takesPart = comm->getRank() < ranks;
    if (firstRanks.count(ranks) == 0)
      firstRanks[ranks] = comm->split(takesPart ? 0 : -1, comm->getRank());
    if (takesPart) {
      const CaseResult result = runCase(trial, firstRanks.at(ranks));
      table.rows.push_back(rowOf(trial, result));
      summary.add(trial, result);
      if (comm->getRank() == 0 && !isAsExpected(trial.expected, result))
        std::cout << trial.family << ": " << trial.name << ", " << trial.parameter << ", " << trial.variant
                  << ": expected " << toString(trial.expected) << ", found " << toString(result.outcome)
                  << " (" << result.status << ": " << result.reason << ")\n"
                  << std::flush;
    }
    sleepTogether(*comm);
  }
  if (comm->getRank() == 0) {
    const Tally& all = summary.all();
    std::cout << summary.markdown() << all.total << " cases: " << all.solved << " solved, " << all.refused
              << " refused, " << all.stopped << " stopped, " << all.unexpected << " not as expected\n";
    if (leftOut > 0)
      std::cout << leftOut << " cases need more ranks: mpirun --oversubscribe -n 7\n";
  }
  writeFiles(directory, {{"stability.csv", table.csv()}, {"stability.md", summary.markdown()}}, *comm);
  int unexpected = summary.all().unexpected; // rank 0 has run all
  MPI_Bcast(&unexpected, 1, MPI_INT, 0, *dynamic_cast<const Teuchos::MpiComm<int>&>(*comm).getRawMpiComm());
  return unexpected == 0;
}

} // namespace epafi::drivers
