#include "epafi/fem/StiffnessPattern.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace epafi::fem {
namespace {

/// For each node, the corners of elements that lie at it, ascending.
class CornersOfNodes {
public:
  explicit CornersOfNodes(const LocalNumbering& numbering) : start_(numbering.numNodes() + 1, 0) {
    const std::span<const int> number = numbering.numElementsAt(), nodeOf = numbering.corners();
    std::partial_sum(number.begin(), number.end(), start_.begin() + 1);
    corners_.resize(start_.back());
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t corner = 0; corner < nodeOf.size(); ++corner)
      if (!numbering.isFilling(corner))
        corners_[next[nodeOf[corner]]++] = static_cast<int>(corner);
  }

  std::span<const int> operator[](std::size_t node) const {
    return {corners_.data() + start_[node], corners_.data() + start_[node + 1]};
  }

private:
  std::vector<int> start_, corners_;
};

} // namespace

/// The rows in which the columns of one node have entries: the free values of its neighbours.
class StiffnessPattern::NodeColumn {
public:
  NodeColumn(const LocalNumbering& numbering, std::size_t components, const std::vector<int>& unknownOf)
      : numbering_(numbering), components_(components), unknownOf_(unknownOf),
        seenBy_(numbering.numNodes(), -1), place_(unknownOf.size(), -1) {}

  void moveTo(std::size_t node, std::span<const int> corners) {
    neighbours_.clear();
    const auto perElement = static_cast<int>(numbering_.nodesPerElement());
    const auto me = static_cast<int>(node);
    for (const int corner : corners)
      for (const int other : numbering_.elementNodes(corner / perElement))
        if (std::exchange(seenBy_[other], me) != me)
          neighbours_.push_back(other);
    std::sort(neighbours_.begin(), neighbours_.end());
    rows_.clear();
    for (const int other : neighbours_)
      for (std::size_t c = 0; c < components_; ++c) {
        const std::size_t position = other * components_ + c;
        if (unknownOf_[position] < 0)
          continue;
        place_[position] = static_cast<int>(rows_.size());
        rows_.push_back(unknownOf_[position]);
      }
  }

  [[nodiscard]] std::span<const int> rows() const { return rows_; }
  /// Place among the rows of a neighbour's free position.
  [[nodiscard]] int placeOf(std::size_t position) const { return place_[position]; }

private:
  const LocalNumbering& numbering_;
  std::size_t components_;
  const std::vector<int>& unknownOf_;
  std::vector<int> neighbours_, rows_;
  std::vector<int> seenBy_; ///< last node that found each node among its neighbours
  std::vector<int> place_;  ///< of each position; out of date where it is no neighbour's
};

StiffnessPattern::StiffnessPattern(std::shared_ptr<const LocalNumbering> numbering, int components,
                                   std::vector<int> unknownOf)
    : numbering_(std::move(numbering)), components_(components),
      valuesPerElement_(numbering_->nodesPerElement() * components_),
      unknownOf_(std::move(unknownOf)), columnStart_{0},
      places_(numbering_->numElements() * valuesPerElement_ * valuesPerElement_, -1) {
  findSupportedElements();
  const CornersOfNodes cornersOf(*numbering_);
  NodeColumn column(*numbering_, components_, unknownOf_);
  for (std::size_t node = 0; node < numbering_->numNodes(); ++node) {
    column.moveTo(node, cornersOf[node]);
    for (std::size_t c = 0; c < components_; ++c)
      if (unknownOf_[node * components_ + c] >= 0)
        addColumn(column, cornersOf[node], c);
  }
}

void StiffnessPattern::findSupportedElements() {
  const std::span<const int> corners = numbering_->corners();
  const std::size_t perElement = numbering_->nodesPerElement();
  const auto isSupported = [this](int node) {
    const auto first = unknownOf_.begin() + components_ * node;
    const auto end = first + components_;
    return std::find(first, end, -1) != end;
  };
  for (std::size_t element = 0; element < numbering_->numElements(); ++element) {
    const std::span<const int> nodes = corners.subspan(element * perElement, perElement);
    if (std::any_of(nodes.begin(), nodes.end(), isSupported))
      supportedElements_.push_back(element);
  }
}

void StiffnessPattern::addColumn(const NodeColumn& column, std::span<const int> corners,
                                 std::size_t component) {
  const auto start = static_cast<int>(rows_.size());
  rows_.insert(rows_.end(), column.rows().begin(), column.rows().end());
  columnStart_.push_back(static_cast<int>(rows_.size()));
  const auto perElement = static_cast<int>(numbering_->nodesPerElement());
  for (const int corner : corners) {
    const std::size_t element = corner / perElement;
    const std::size_t value = corner % perElement * components_ + component;
    auto place = places_.begin() + (element * valuesPerElement_ + value) * valuesPerElement_;
    for (const int node : numbering_->elementNodes(element))
      for (std::size_t c = 0; c < components_; ++c, ++place) {
        const std::size_t position = node * components_ + c;
        if (unknownOf_[position] >= 0)
          *place = start + column.placeOf(position);
      }
  }
}

void StiffnessPattern::shape(Eigen::SparseMatrix<double, Eigen::ColMajor, int>& stiffness) const {
  const Eigen::Index size = columnStart_.size() - 1;
  stiffness.resize(size, size);
  stiffness.resizeNonZeros(rows_.size());
  std::copy(columnStart_.begin(), columnStart_.end(), stiffness.outerIndexPtr());
  std::copy(rows_.begin(), rows_.end(), stiffness.innerIndexPtr());
  std::fill_n(stiffness.valuePtr(), rows_.size(), 0.0);
}

} // namespace epafi::fem
