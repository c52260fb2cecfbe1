#pragma once

/// Elements as guaranteed bounds look at them: those of this rank, and around them those that share a node
/// with one of them, so that all that happens at a node of the rank's own elements is known here.

#include "epafi/accuracy/BodyElements.hpp"
#include "epafi/fem/CompositeStress.hpp"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace epafi::accuracy {

/// The least numbers of a facet's corners, ascending, and of an edge the greatest number there is.
using FacetKey = std::array<GlobalOrdinal, 3>;
/// \param nodes  of a facet, its corners first
FacetKey facetKey(mesh::CellType facet, std::span<const GlobalOrdinal> nodes);

/// An element as one of its nodes sees it.
struct CellCorner {
  std::size_t place = 0; ///< of the element
  int node = 0;          ///< its node
};

/// Of one body.
class BoundCells {
public:
  /// Keeps references to scene body and layout. \throws InputError if elements are no simplices,
  /// parallelograms or parallelepipeds with straight edges.
  BoundCells(const scene::Body& body, const model::BodyLayout& layout,
             const decomposition::DecomposedProblem& problem, int number);

  [[nodiscard]] std::size_t numOwn() const { return numOwn_; }
  [[nodiscard]] std::size_t number() const { return elements_.size(); } ///< own ones first
  [[nodiscard]] GlobalOrdinal elementAt(std::size_t place) const { return elements_[place]; }
  /// Its nodes, as the body numbers them and as they are numbered here.
  [[nodiscard]] std::span<const GlobalOrdinal> nodesAt(std::size_t place) const {
    return std::span(nodes_).subspan(place * perElement_, perElement_);
  }
  [[nodiscard]] std::span<const int> localsAt(std::size_t place) const {
    return std::span(locals_).subspan(place * perElement_, perElement_);
  }
  /// Nodes of own elements come first, as many as numOwnNodes().
  [[nodiscard]] int numOwnNodes() const { return numOwnNodes_; }
  [[nodiscard]] GlobalOrdinal nodeAt(int local) const { return numbers_[local]; }
  /// −1: no own element has it.
  [[nodiscard]] int localOf(GlobalOrdinal node) const {
    const auto found = localOf_.find(node);
    return found == localOf_.end() || found->second >= numOwnNodes_ ? -1 : found->second;
  }
  /// All elements at a node of an own one.
  [[nodiscard]] std::span<const CellCorner> around(int local) const {
    return std::span(around_).subspan(firstAround_[local], firstAround_[local + 1] - firstAround_[local]);
  }
  [[nodiscard]] std::span<const mesh::Facet> facets() const { return facetsOf(mesh().cellType()); }
  [[nodiscard]] mesh::CellType facetType() const { return facetTypeOf(mesh().cellType()); }
  [[nodiscard]] FacetKey facetAt(std::size_t place, int facet) const;
  [[nodiscard]] const mesh::Mesh& mesh() const { return *layout_.mesh; }
  [[nodiscard]] const scene::Body& body() const { return body_; }
  [[nodiscard]] const fem::BodyModel& model() const { return *model_; }
  [[nodiscard]] int components() const { return model_->components(); }
  /// Stresses of an element: shared by all of a material where elements are congruent, else in `own`.
  const fem::CellStress& stressAt(std::size_t place, std::optional<fem::CellStress>& own) const;
  /// Stiffness of an element; likewise.
  const Eigen::MatrixXd& stiffnessAt(std::size_t place, Eigen::MatrixXd& own) const;
  [[nodiscard]] const fem::Material& materialAt(std::size_t place) const {
    return model_->materialOf(elements_[place]);
  }

private:
  void gather(const decomposition::DecomposedProblem& problem, int number);
  void numberNodes();
  void requireStraight() const;

  const scene::Body& body_;
  const model::BodyLayout& layout_;
  std::unique_ptr<fem::BodyModel> model_;
  std::size_t perElement_, numOwn_ = 0;
  int numOwnNodes_ = 0;
  std::vector<GlobalOrdinal> elements_, nodes_, numbers_;
  std::vector<int> locals_;
  std::unordered_map<GlobalOrdinal, int> localOf_;
  std::vector<std::size_t> firstAround_;
  std::vector<CellCorner> around_;
  std::vector<GlobalOrdinal> kinds_; ///< region of each element, if they are congruent
  /// Of each region, if they are congruent.
  mutable std::vector<std::optional<fem::CellStress>> stresses_;
  mutable std::vector<Eigen::MatrixXd> stiffnesses_;
};

/// Displacements at the nodes of all cells of all bodies, a column each. \param displacement  of each of this
/// rank's subdomains, in which the rank's own cells are; others come from their ranks. Collective.
std::vector<Eigen::MatrixXd> displacementsOf(const std::vector<std::unique_ptr<BoundCells>>& cells,
                                             const model::Decomposition& decomposition,
                                             std::span<const Eigen::VectorXd> displacement);

} // namespace epafi::accuracy
