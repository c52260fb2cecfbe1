#pragma once

/// Contact between nodes as guaranteed bounds need it: pressures ≥ 0 on facets, the same on both sides, in
/// place of forces at nodes; and gaps between the nodes, too.

#include "epafi/accuracy/BoundLoads.hpp"
#include "epafi/fem/FacetFunctions.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::accuracy {

/// A facet of the first side and what it faces.
struct ContactFacet {
  mesh::CellType type{};
  int first = 0, second = -1;      ///< bodies; −1: an obstacle
  std::vector<GlobalOrdinal> rows; ///< those that belong to its nodes, in their order
  std::vector<GlobalOrdinal> nodes, facing;
  Eigen::VectorXd direction;
  double measure = 0;       ///< length or area
  Eigen::VectorXd pressure; ///< in terms of FacetFunctions, nodes' order, times the thickness

  [[nodiscard]] const fem::FacetFunctions& functions() const { return fem::FacetFunctions::of(type); }
  [[nodiscard]] Eigen::VectorXd moments() const { return measure * (functions().moments * pressure); }
};

/// Forces and gaps are those of nodes with rows: in the place of the row that belongs to a node.
class ContactPressure {
public:
  /// \throws InputError for contacts that are no pairs of nodes on straight lines or planes, or have friction
  /// or springs. Not collective.
  ContactPressure(const scene::Scene& scene, const model::Decomposition& decomposition);

  [[nodiscard]] std::span<const ContactFacet> facets() const { return facets_; }
  /// Pressures near to the forces of rows. Returns the rows' forces that they amount to.
  std::vector<double> fit(std::span<const double> forces);
  /// Adds them to what acts on the bodies.
  void addTo(std::vector<BoundLoads>& loads) const;
  /// ∫ p (g − [v]) of what is left of the gap at each node.
  [[nodiscard]] double work(std::span<const double> slack) const;
  /// By what the gap has to grow at each node for no point of a facet to penetrate.
  [[nodiscard]] std::vector<double> lacking(std::span<const double> slack) const;
  [[nodiscard]] std::span<const double> gaps() const { return gaps_; }

private:
  using Shares = std::vector<std::pair<std::size_t, double>>;

  void addContact(const contact::ContactLayout& contact, const model::Decomposition& decomposition);
  [[nodiscard]] static std::vector<double> combined(const std::vector<Shares>& shares,
                                                    std::span<const double> values);

  std::vector<ContactFacet> facets_;
  std::vector<double> gaps_;
  /// Where rows are dual to other functions: what the force of a node is of those of rows, and the other way
  /// round.
  std::vector<Shares> ofNodes_, ofRows_;
};

} // namespace epafi::accuracy
