#include "epafi/simulation/PreloadResults.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/model/ContactData.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>

namespace epafi::simulation {
namespace {

/// −Jᵀλ. Collective.
double tensionOf(const SolvedScene& solved, const model::PreloadSection& section) {
  const model::Decomposition& cut = solved.decomposition;
  const GlobalOrdinal first = model::firstEquation(cut.ties, cut.problem) + section.firstEquation;
  const auto multiplier = solved.solution.multiplier->getData();
  std::array<AccurateSum, 1> sum;
  for (std::size_t k = 0; k < section.shares.size(); ++k)
    if (const LocalOrdinal own =
            cut.problem.multiplierMap->getLocalElement(first + static_cast<GlobalOrdinal>(k));
        own >= 0)
      sum[0].add(-section.shares[k] * multiplier[own]);
  sumOverRanks(solved.comm(), sum);
  return sum[0].value();
}

/// B_p u / J_p. Collective.
double shorteningOf(const SolvedScene& solved, const model::PreloadSection& section) {
  double sum = 0;
  for (const contact::Equation::Term& term : section.pilot.terms)
    sum += term.direction.dot(displacementsAt(solved, term.body, std::array{term.node}).front());
  return sum / section.pilotShare;
}

} // namespace

std::vector<PreloadResult> preloadResults(const SolvedScene& solved) {
  std::vector<PreloadResult> results;
  for (const model::PreloadSection& section : solved.decomposition.sections) {
    const scene::Preload& preload = *solved.scene.contacts[section.number].preload;
    results.push_back({section.name, preload.holdsLength() ? tensionOf(solved, section) : preload.value,
                       preload.holdsLength() ? preload.value : shorteningOf(solved, section)});
  }
  return results;
}

std::vector<Eigen::Vector3d> displacementsAt(const SolvedScene& solved, int body,
                                             std::span<const GlobalOrdinal> nodes) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(4, static_cast<Eigen::Index>(nodes.size())); // last: copies
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    for (std::size_t k = 0; k < nodes.size() && subdomain.body == body; ++k) {
      const auto found = std::lower_bound(subdomain.nodes.begin(), subdomain.nodes.end(), nodes[k]);
      if (found == subdomain.nodes.end() || *found != nodes[k])
        continue;
      const Eigen::Index first = (found - subdomain.nodes.begin()) * problem.components;
      sums.col(k).head(problem.components) +=
          solved.solution.displacement[s].segment(first, problem.components);
      sums(3, k) += 1;
    }
  }
  sumOverRanks(solved.comm(), std::span(sums.data(), static_cast<std::size_t>(sums.size())));
  std::vector<Eigen::Vector3d> result;
  for (Eigen::Index k = 0; k < sums.cols(); ++k)
    result.emplace_back(sums.col(k).head(3) / sums(3, k));
  return result;
}

} // namespace epafi::simulation
