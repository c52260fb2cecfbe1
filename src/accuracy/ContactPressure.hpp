#pragma once

/// Contact between nodes as guaranteed bounds need it: pressures ≥ 0 on edges, the same on both sides, in
/// place of forces at nodes; and gaps between the nodes, too.

#include "epafi/accuracy/BoundLoads.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace epafi::accuracy {

/// An edge of the first side and what it faces.
struct ContactEdge {
  int first = 0, second = -1;      ///< bodies; −1: an obstacle
  std::vector<GlobalOrdinal> rows; ///< of its nodes, in their order
  std::vector<GlobalOrdinal> nodes, facing;
  Eigen::VectorXd direction;
  double length = 0;
  Eigen::VectorXd pressure; ///< in terms of Bernstein's polynomials, nodes' order, times the thickness
};

class ContactPressure {
public:
  /// \throws InputError for contacts that are no pairs of nodes on straight lines, or have friction or
  /// springs. Not collective.
  ContactPressure(const scene::Scene& scene, const model::Decomposition& decomposition);

  [[nodiscard]] std::span<const ContactEdge> edges() const { return edges_; }
  /// Pressures near to the forces of rows. Returns the forces at the rows' nodes that they amount to.
  std::vector<double> fit(std::span<const double> forces);
  /// Adds them to what acts on the bodies.
  void addTo(std::vector<BoundLoads>& loads) const;
  /// ∫ p (g − [v]) of what is left of the gap at each row.
  [[nodiscard]] double work(std::span<const double> slack) const;
  /// By what the gap has to grow at each row for no point of an edge to penetrate.
  [[nodiscard]] std::vector<double> lacking(std::span<const double> slack) const;
  [[nodiscard]] std::span<const double> gaps() const { return gaps_; } ///< of each row

private:
  [[nodiscard]] static Eigen::VectorXd momentsOf(const ContactEdge& edge);

  std::vector<ContactEdge> edges_;
  std::vector<double> gaps_;
};

} // namespace epafi::accuracy
