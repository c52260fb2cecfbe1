#include "epafi/decomposition/EdgeAverages.hpp"

#include <algorithm>
#include <map>
#include <span>

namespace epafi::decomposition {
namespace {

/// How many changed matrices are remembered.
constexpr std::size_t maxKnown = 64;

std::size_t numFree(const Piece& piece, std::size_t node, std::size_t components) {
  const auto unknowns = std::span(piece.assembled.unknownOf).subspan(node * components, components);
  return static_cast<std::size_t>(
      std::count_if(unknowns.begin(), unknowns.end(), [](int unknown) { return unknown >= 0; }));
}

/// T.
SparseMatrix basisOf(const std::vector<Average>& averages, Eigen::Index size) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < static_cast<int>(size); ++i)
    entries.emplace_back(i, i, 1.0);
  for (const Average& average : averages)
    for (const int other : average.others) {
      entries.emplace_back(other, average.carrier, 1.0);
      entries.emplace_back(average.carrier, other, -1.0);
    }
  SparseMatrix basis(size, size);
  basis.setFromTriplets(entries.begin(), entries.end());
  return basis;
}

} // namespace

bool hasEdgeAverages(int dimension, std::size_t components) {
  return dimension == 3 || components > 1;
}

void findEdgeAverages(int dimension, std::size_t components, Piece& piece) {
  const std::size_t leastParts = dimension == 3 ? 3 : 2;
  std::map<std::vector<int>, std::vector<std::size_t>> edges; // in the order of their parts
  for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
    const std::span<const int> parts = piece.sharing.parts(k);
    const std::size_t node = piece.sharing.node(k);
    if (parts.size() >= leastParts && piece.isCrosspoint[node] == 0 && numFree(piece, node, components) > 0)
      edges[{parts.begin(), parts.end()}].push_back(node);
  }
  piece.averages.clear();
  for (auto& [parts, nodes] : edges) {
    if (nodes.size() < 2)
      continue;
    const auto carrier = std::max_element(nodes.begin(), nodes.end(), [&](std::size_t a, std::size_t b) {
      return numFree(piece, a, components) < numFree(piece, b, components);
    });
    EdgeAverage average{*carrier, {}};
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(average.others),
                 [&](std::size_t node) { return node != average.carrier; });
    piece.averages.push_back(std::move(average));
  }
}

std::vector<Average> averagesOf(const Piece& piece, std::size_t components) {
  std::vector<Average> averages;
  for (const EdgeAverage& edge : piece.averages)
    for (std::size_t c = 0; c < components; ++c) {
      const auto unknownAt = [&](std::size_t node) {
        return piece.assembled.unknownOf[node * components + c];
      };
      Average average{unknownAt(edge.carrier), {}};
      if (average.carrier < 0)
        continue;
      for (const std::size_t node : edge.others)
        if (unknownAt(node) >= 0)
          average.others.push_back(unknownAt(node));
      if (!average.others.empty())
        averages.push_back(std::move(average));
    }
  return averages;
}

void changeBasisOfRows(const std::vector<Average>& averages, std::size_t first, std::vector<RowEntry>& rows) {
  if (averages.empty())
    return;
  std::map<int, const Average*> averageOf; // of each unknown that is in one
  for (const Average& average : averages) {
    averageOf[average.carrier] = &average;
    for (const int other : average.others)
      averageOf[other] = &average;
  }
  std::map<std::pair<GlobalOrdinal, int>, double> changed;
  for (std::size_t k = first; k < rows.size(); ++k) {
    const RowEntry& entry = rows[k];
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
  rows.resize(first);
  for (const auto& [place, coefficient] : changed)
    if (coefficient != 0)
      rows.push_back({place.first, place.second, coefficient});
}

void toNodalValues(const Subdomain& subdomain, Eigen::Ref<Eigen::VectorXd> u) {
  for (const Average& average : subdomain.averages) {
    const double mean = u[average.carrier];
    for (const int other : average.others) {
      u[average.carrier] -= u[other];
      u[other] += mean;
    }
  }
}

void changeBasisOfLoad(const std::vector<Average>& averages, Eigen::VectorXd& load) {
  for (const Average& average : averages) {
    const double atCarrier = load[average.carrier];
    for (const int other : average.others) {
      load[average.carrier] += load[other];
      load[other] -= atCarrier;
    }
  }
}

std::shared_ptr<const SparseMatrix> AverageBasis::changed(const std::vector<Average>& averages,
                                                          const std::shared_ptr<const SparseMatrix>& nodal) {
  if (averages.empty())
    return nodal;
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& k) { return k.nodal == nodal && k.averages == averages; });
  if (known != known_.end())
    return known->changed;
  const SparseMatrix basis = basisOf(averages, nodal->rows());
  const SparseMatrix product = SparseMatrix(basis.transpose()) * (*nodal * basis).eval();
  const auto changed = std::make_shared<SparseMatrix>(
      0.5 * (product + SparseMatrix(product.transpose()))); // symmetric to the last digit
  changed->makeCompressed();
  if (known_.size() >= maxKnown)
    known_.erase(known_.begin());
  known_.push_back({nodal, changed, averages});
  return changed;
}

void AverageBasis::change(const std::vector<Average>& averages, Piece& piece) {
  piece.stiffness = changed(averages, piece.stiffness);
  changeBasisOfLoad(averages, piece.assembled.load);
  Eigen::MatrixXd& kernel = piece.assembled.kernel;
  for (const Average& average : averages) {
    Eigen::RowVectorXd mean = kernel.row(average.carrier);
    for (const int other : average.others)
      mean += kernel.row(other);
    mean /= static_cast<double>(average.others.size() + 1);
    kernel.row(average.carrier) = mean;
    for (const int other : average.others)
      kernel.row(other) -= mean;
  }
}

} // namespace epafi::decomposition
