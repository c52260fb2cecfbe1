#include "ScalingSeries.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::drivers {
namespace {

void addOnce(const Row& row, std::vector<Row>& runs) {
  if (std::none_of(runs.begin(), runs.end(),
                   [&](const Row& other) { return other.isLike(row, scalingSettings); }))
    runs.push_back(row);
}

/// \param all  whether forms of F and preconditioners are combined, or one of both is the default
void addCombinations(Row row, bool all, std::vector<Row>& runs) {
  for (const char* dualOperator : {"implicit", "explicit", "shared"})
    for (const auto& [preconditioner, precision] : {std::pair{"dirichlet", "double"},
                                                    {"dirichlet", "single"},
                                                    {"lumped", "double"},
                                                    {"lumped", "single"},
                                                    {"none", "double"}}) {
      row["operator"] = dualOperator;
      row["preconditioner"] = preconditioner;
      row["precision"] = precision;
      if (all || row.text("operator") == "shared" ||
          scalingRun("", 0, 0).isLike(row, {"preconditioner", "precision"}))
        addOnce(row, runs);
    }
}

} // namespace

ScalingSizes::ScalingSizes(bool quick)
    : subdomains(quick ? std::vector{2, 4, 8} : std::vector{2, 4, 8, 16, 32}),
      fixedElements(quick ? std::vector{8} : std::vector{8, 16}),
      elements(quick ? std::vector{4, 8, 16} : std::vector{4, 8, 16, 32, 64}),
      allCombinations(quick ? std::vector{8} : std::vector{8, 16}),
      someCombinations(quick ? std::vector{16} : std::vector{32, 64}), strongSubdomains(quick ? 8 : 32),
      weakSubdomains(quick ? 4 : 16), ranksElements(quick ? 8 : 16),
      coarse(quick ? std::vector{4, 8, 16} : std::vector{4, 8, 16, 32, 64, 128}),
      coarseBlocks(quick ? std::vector{2, 3, 4} : std::vector{2, 4, 6, 8, 10}), blocks(4),
      blocksElements(quick ? 4 : 6), streamBytes(quick ? 3e8 : 1.5e9), blockBytes(quick ? 2e7 : 5e8) {}

int ScalingSizes::weakOn(double ranks) const {
  return static_cast<int>(std::lround(weakSubdomains * std::sqrt(ranks)));
}

std::vector<Row> runsOnRanks(const ScalingSizes& sizes, int ranks) {
  std::vector<Row> runs;
  for (const int subdomains : {sizes.strongSubdomains, sizes.weakOn(ranks)})
    for (const char* dualOperator : {"shared", "explicit"}) {
      Row row = scalingRun("coercive", subdomains, sizes.ranksElements, ranks);
      row["operator"] = dualOperator;
      addOnce(row, runs);
    }
  for (const char* problem : {"coercive", "blocks"}) {
    const bool isBlocks = problem == std::string("blocks");
    const int side = isBlocks ? sizes.blocks : sizes.strongSubdomains;
    const int ofBody = isBlocks ? side * side * side : side * side;
    for (const int cluster : {0, 1, 2 * ofBody / ranks, 8 * ofBody / ranks}) { // a rank's, four ranks'
      Row row = scalingRun(problem, side, isBlocks ? sizes.blocksElements : sizes.ranksElements, ranks);
      row["cluster"] = cluster < ofBody ? cluster : 0; // of the whole body
      if (isBlocks)
        row["operator"] = "implicit";
      addOnce(row, runs);
    }
  }
  return runs;
}

std::vector<Row> runsOnOneRank(const ScalingSizes& sizes) {
  std::vector<Row> runs;
  for (const char* problem : {"coercive", "semicoercive"}) {
    for (const int elements : sizes.fixedElements)
      for (const int subdomains : sizes.subdomains)
        addOnce(scalingRun(problem, subdomains, elements), runs);
    for (const int elements : sizes.elements)
      addOnce(scalingRun(problem, sizes.fixedSubdomains, elements), runs);
  }
  for (const bool all : {true, false})
    for (const int elements : all ? sizes.allCombinations : sizes.someCombinations)
      addCombinations(scalingRun("coercive", sizes.fixedSubdomains, elements), all, runs);
  for (const Row& row : runsOnRanks(sizes, 1))
    addOnce(row, runs);
  return runs;
}

} // namespace epafi::drivers
