#include "ScalingSeries.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::drivers {
namespace {

ScalingRow run(const char* problem, int subdomains, int elements, double ranks = 1) {
  ScalingRow row;
  row.problem = problem;
  row.subdomainsPerSide = subdomains;
  row.elementsPerSide = elements;
  row.ranks = ranks;
  return row;
}

void addOnce(const ScalingRow& row, std::vector<ScalingRow>& runs) {
  if (std::none_of(runs.begin(), runs.end(), [&](const ScalingRow& other) { return other.isSameRun(row); }))
    runs.push_back(row);
}

/// \param all  whether forms of F and preconditioners are combined, or one of both is the default
void addCombinations(ScalingRow row, bool all, std::vector<ScalingRow>& runs) {
  using Choice = std::pair<const char*, const char*>;
  for (const char* dualOperator : {"implicit", "explicit", "shared"})
    for (const auto& [preconditioner, precision] :
         {Choice{"dirichlet", "double"}, Choice{"dirichlet", "single"}, Choice{"lumped", "double"},
          Choice{"lumped", "single"}, Choice{"none", "double"}}) {
      row.dualOperator = dualOperator;
      row.preconditioner = preconditioner;
      row.precision = precision;
      const bool isDefault = row.preconditioner == "dirichlet" && row.precision == "double";
      if (all || isDefault || row.dualOperator == "shared")
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
      streamBytes(quick ? 3e8 : 1.5e9), blockBytes(quick ? 2e7 : 5e8) {}

int ScalingSizes::weakOn(double ranks) const {
  return static_cast<int>(std::lround(weakSubdomains * std::sqrt(ranks)));
}

std::vector<ScalingRow> runsOnRanks(const ScalingSizes& sizes, int ranks) {
  std::vector<ScalingRow> runs;
  for (const int subdomains : {sizes.strongSubdomains, sizes.weakOn(ranks)})
    for (const char* dualOperator : {"shared", "explicit"}) {
      ScalingRow row = run("coercive", subdomains, sizes.ranksElements, ranks);
      row.dualOperator = dualOperator;
      addOnce(row, runs);
    }
  return runs;
}

std::vector<ScalingRow> runsOnOneRank(const ScalingSizes& sizes) {
  std::vector<ScalingRow> runs;
  for (const char* problem : {"coercive", "semicoercive"}) {
    for (const int elements : sizes.fixedElements)
      for (const int subdomains : sizes.subdomains)
        addOnce(run(problem, subdomains, elements), runs);
    for (const int elements : sizes.elements)
      addOnce(run(problem, sizes.fixedSubdomains, elements), runs);
  }
  for (const bool all : {true, false})
    for (const int elements : all ? sizes.allCombinations : sizes.someCombinations)
      addCombinations(run("coercive", sizes.fixedSubdomains, elements), all, runs);
  for (const ScalingRow& row : runsOnRanks(sizes, 1))
    addOnce(row, runs);
  return runs;
}

} // namespace epafi::drivers
