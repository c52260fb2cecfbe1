#include "epafi/decomposition/EdgeAverages.hpp"

#include <algorithm>
#include <map>
#include <span>

namespace epafi::decomposition {
namespace {

/// How many changed matrices are remembered.
constexpr std::size_t maxKnown = 64;

/// N = T − I, which has entries at edges alone.
SparseMatrix changeOf(const std::vector<Average>& averages, Eigen::Index size) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Average& average : averages)
    for (const int other : average.others) {
      entries.emplace_back(other, average.carrier, 1.0);
      entries.emplace_back(average.carrier, other, -1.0);
    }
  SparseMatrix change(size, size);
  change.setFromTriplets(entries.begin(), entries.end());
  return change;
}

} // namespace

bool hasEdgeAverages(const Substructures& all) {
  return all.places.dimension == 3 || isElastic(all.components);
}

std::vector<EdgeAverage> findEdgeAverages(const Substructures& all, const SharedNodes& shared,
                                          std::size_t subdomain, const std::vector<char>& isCrosspoint) {
  const std::size_t fewest = all.places.dimension == 3 ? 3 : 2;
  std::map<std::vector<int>, std::vector<std::size_t>>
      edges; // in the order of the subdomains that share them
  for (const SharedNodes::Copy& copy : shared.copiesOf(subdomain))
    if (const std::span<const int> numbers = shared.subdomainsAt(copy.node);
        numbers.size() >= fewest && isCrosspoint[copy.place] == 0 && all.isFree(subdomain, copy.place))
      edges[{numbers.begin(), numbers.end()}].push_back(copy.place);
  std::vector<EdgeAverage> averages;
  for (const auto& [numbers, nodes] : edges) {
    if (nodes.size() < 2)
      continue;
    const auto carrier = std::max_element(nodes.begin(), nodes.end(), [&](std::size_t a, std::size_t b) {
      return all.numFree(subdomain, a) < all.numFree(subdomain, b);
    });
    EdgeAverage average{*carrier, {}};
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(average.others),
                 [&](std::size_t node) { return node != average.carrier; });
    averages.push_back(std::move(average));
  }
  return averages;
}

std::vector<Average> averagesOf(const Substructures& all, std::size_t subdomain,
                                const std::vector<EdgeAverage>& edges) {
  std::vector<Average> averages;
  for (const EdgeAverage& edge : edges)
    for (int c = 0; c < all.components; ++c) {
      Average average{all.unknownsAt(subdomain, edge.carrier)[c], {}};
      if (average.carrier < 0)
        continue;
      for (const std::size_t node : edge.others)
        if (const int unknown = all.unknownsAt(subdomain, node)[c]; unknown >= 0)
          average.others.push_back(unknown);
      if (!average.others.empty())
        averages.push_back(std::move(average));
    }
  return averages;
}

std::vector<RowEntry> inBasisOf(const std::vector<Average>& averages, std::vector<RowEntry> rows) {
  if (averages.empty())
    return rows;
  std::map<int, const Average*> averageOf; // of each unknown that is in one
  for (const Average& average : averages) {
    averageOf[average.carrier] = &average;
    for (const int other : average.others)
      averageOf[other] = &average;
  }
  std::map<std::pair<GlobalOrdinal, int>, double> changed;
  for (const RowEntry& entry : rows) {
    changed[{entry.row, entry.unknown}] += entry.coefficient;
    const auto found = averageOf.find(entry.unknown);
    if (found == averageOf.end())
      continue;
    const Average& average = *found->second;
    if (entry.unknown == average.carrier)
      for (const int other : average.others)
        changed[{entry.row, other}] -= entry.coefficient; // a − Σ ũ_i
    else
      changed[{entry.row, average.carrier}] += entry.coefficient; // ũ_i + a
  }
  rows.clear();
  for (const auto& [place, coefficient] : changed)
    if (coefficient != 0)
      rows.push_back({place.first, place.second, coefficient});
  return rows;
}

Eigen::VectorXd loadInBasisOf(const std::vector<Average>& averages, Eigen::VectorXd load) {
  for (const Average& average : averages) {
    const double atCarrier = load[average.carrier];
    for (const int other : average.others) {
      load[average.carrier] += load[other];
      load[other] -= atCarrier;
    }
  }
  return load;
}

Eigen::MatrixXd kernelInBasisOf(const std::vector<Average>& averages, Eigen::MatrixXd kernel) {
  for (const Average& average : averages) {
    Eigen::RowVectorXd mean = kernel.row(average.carrier);
    for (const int other : average.others)
      mean += kernel.row(other);
    mean /= static_cast<double>(average.others.size() + 1);
    kernel.row(average.carrier) = mean;
    for (const int other : average.others)
      kernel.row(other) -= mean;
  }
  return kernel;
}

std::shared_ptr<const SparseMatrix> AverageBasis::changed(const std::vector<Average>& averages,
                                                          const std::shared_ptr<const SparseMatrix>& nodal) {
  if (averages.empty())
    return nodal;
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& k) { return k.nodal == nodal && k.averages == averages; });
  if (known != known_.end())
    return known->changed;
  const SparseMatrix n = changeOf(averages, nodal->rows());
  const SparseMatrix kn = *nodal * n;
  const SparseMatrix half = kn + 0.5 * SparseMatrix(SparseMatrix(n.transpose()) * kn); // KN + ½NᵀKN
  const SparseMatrix change = half + SparseMatrix(half.transpose()); // symmetric to the last digit
  const auto changed = std::make_shared<SparseMatrix>(*nodal + change);
  changed->makeCompressed();
  if (known_.size() >= maxKnown)
    known_.erase(known_.begin());
  known_.push_back({nodal, changed, averages});
  return changed;
}

} // namespace epafi::decomposition
