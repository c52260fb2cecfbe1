#include "epafi/accuracy/EquilibratedTractions.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::accuracy {
namespace {

/// Forces of one body's cells.
struct CellForces {
  Eigen::MatrixXd residual;  ///< ∫ σ:ε(N_a) − f N_a
  Eigen::MatrixXd tractions; ///< moments of σn
};

CellForces forcesOf(const BoundCells& cells, const BoundLoads& loads, const Eigen::MatrixXd& displacements) {
  CellForces forces{-loads.volume, {}};
  Eigen::MatrixXd ownStiffness;
  std::optional<fem::CellStress> own;
  for (std::size_t place = 0; place < cells.number(); ++place) {
    const Eigen::VectorXd u = displacements.col(place);
    forces.residual.col(place).noalias() += cells.stiffnessAt(place, ownStiffness) * u;
    const fem::CellStress& stress = cells.stressAt(place, own);
    if (place == 0)
      forces.tractions.resize(stress.numTractions(), cells.number());
    forces.tractions.col(place) = stress.tractions(u);
  }
  return forces;
}

/// The problem at one node.
class Star {
public:
  Star(const BoundCells& cells, const BoundLoads& loads, const CellForces& forces)
      : cells_(cells), loads_(loads), forces_(forces), facets_(cells.facets()),
        components_(cells.components()) {}

  void solve(int node, EquilibratedTractions& result) {
    gather(node);
    const bool areAlike = std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
      return side.given == nullptr ||
             std::all_of(side.given->isHeld.begin(), side.given->isHeld.begin() + components_,
                         [&](bool isHeld) { return isHeld == side.given->isHeld[0]; });
    });
    if (areAlike)
      balance(0, components_, result);
    else
      for (Eigen::Index c = 0; c < components_; ++c)
        balance(c, 1, result);
  }

private:
  /// A facet at the node, as one of the elements around it sees it.
  struct Side {
    FacetKey key;
    Eigen::Index cell = 0;   ///< which of the elements around the node
    Eigen::Index moment = 0; ///< place of the node's moments among the element's data
    std::size_t other = 0;   ///< the same facet as its other element sees it; itself: there is none
    const BoundaryFacet* given = nullptr;
    Eigen::Index inGiven = 0; ///< place of the node there
  };

  void gather(int node) {
    around_ = cells_.around(node);
    sides_.clear();
    for (std::size_t a = 0; a < around_.size(); ++a)
      for (int k = 0; k < std::ssize(facets_); ++k)
        for (std::size_t i = 0; i < facets_[k].size(); ++i)
          if (facets_[k][i] == around_[a].node)
            sides_.push_back({cells_.facetAt(around_[a].place, k), static_cast<Eigen::Index>(a),
                              static_cast<Eigen::Index>(k * facets_[k].size() + i) * components_});
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      Side& side = sides_[s];
      side.other = s;
      for (std::size_t t = 0; t < sides_.size(); ++t)
        if (t != s && sides_[t].key == side.key)
          side.other = t;
      if (side.other != s)
        continue;
      if (const auto found = loads_.facets.find(side.key); found != loads_.facets.end()) {
        side.given = &found->second;
        const auto& nodes = found->second.nodes;
        side.inGiven = std::find(nodes.begin(), nodes.end(), cells_.nodeAt(node)) - nodes.begin();
      }
    }
  }

  [[nodiscard]] auto own(const Side& side, Eigen::Index first, Eigen::Index count) const {
    return forces_.tractions.col(around_[side.cell].place).segment(side.moment + first, count).transpose();
  }

  /// Moments b of some components, for which the same is held: Σ ± b = r for each element, Σ (b − mean)² the
  /// least, so that b = mean + Aᵀy, AAᵀy = r − A mean.
  void balance(Eigen::Index first, Eigen::Index count, EquilibratedTractions& result) {
    const Eigen::Index number = std::ssize(around_);
    rest_.resize(number, count);
    for (Eigen::Index e = 0; e < number; ++e)
      rest_.row(e) = forces_.residual.col(around_[e].place)
                         .segment(around_[e].node * components_ + first, count)
                         .transpose();
    result.largestForce = std::max(result.largestForce, rest_.cwiseAbs().maxCoeff());
    system_.setZero(number, number);
    values_.resize(std::ssize(sides_), count);
    bool isDetermined = false;
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      const Side& side = sides_[s];
      auto value = values_.row(static_cast<Eigen::Index>(s));
      if (side.other != s) {
        value = 0.5 * (own(side, first, count) - own(sides_[side.other], first, count));
        system_(side.cell, side.cell) += 1;
        system_(side.cell, sides_[side.other].cell) -= 1;
      } else if (side.given != nullptr && side.given->isHeld.at(first)) {
        value = own(side, first, count);
        system_(side.cell, side.cell) += 1;
        isDetermined = true;
      } else if (side.given != nullptr) {
        value = side.given->forces.col(side.inGiven).segment(first, count).transpose();
      } else {
        value.setZero();
      }
      rest_.row(side.cell) -= value;
    }
    Eigen::MatrixXd regular = system_;
    if (!isDetermined)
      regular.array() += 1.0 / static_cast<double>(number); // what is in balance has no share of it
    const Eigen::MatrixXd y = direct::solvedSymmetric(regular, rest_);
    const double left = (rest_ - system_ * y).lpNorm<Eigen::Infinity>();
    result.imbalance = left <= result.imbalance ? result.imbalance : left; // NaN counts
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      const Side& side = sides_[s];
      if (around_[side.cell].place >= cells_.numOwn())
        continue;
      auto value = values_.row(static_cast<Eigen::Index>(s));
      if (side.other != s)
        value += y.row(side.cell) - y.row(sides_[side.other].cell);
      else if (side.given != nullptr && side.given->isHeld.at(first))
        value += y.row(side.cell);
      result.data.col(around_[side.cell].place).segment(side.moment + first, count) = value.transpose();
    }
  }

  const BoundCells& cells_;
  const BoundLoads& loads_;
  const CellForces& forces_;
  std::span<const mesh::Facet> facets_;
  Eigen::Index components_;
  std::span<const CellCorner> around_;
  std::vector<Side> sides_;
  Eigen::MatrixXd rest_, system_, values_;
};

} // namespace

EquilibratedTractions equilibratedTractions(const BoundCells& cells, const BoundLoads& loads,
                                            const Eigen::MatrixXd& displacements) {
  EquilibratedTractions result;
  const CellForces forces = forcesOf(cells, loads, displacements);
  const Eigen::Index numTractions = forces.tractions.rows();
  result.data.setZero(numTractions + cells.components(), cells.numOwn());
  result.data.bottomRows(cells.components()) = loads.load.leftCols(cells.numOwn());
  Star star(cells, loads, forces);
  for (int node = 0; node < cells.numOwnNodes(); ++node)
    star.solve(node, result);
  return result;
}

} // namespace epafi::accuracy
