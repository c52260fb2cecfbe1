#pragma once

/// From pairs of nodes that may meet to rows of B_I over the unknowns of nodes.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/decomposition/FrictionRows.hpp"

#include <Eigen/Core>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace epafi::contact {

/// What rows have to know of nodes, which are named by body and number in the body.
struct NodeUnknowns {
  int components = 1;
  std::vector<GlobalOrdinal> firstNode; ///< of each body: number of its node 0 among those of all
  /// The axes of a node's unknowns, columns of a rotation; null where they are those of space.
  std::function<const Eigen::Matrix3d*(int body, GlobalOrdinal node)> frame;
  /// Whether a support prescribes a component.
  std::function<bool(int body, GlobalOrdinal node, int component)> isHeld;
  /// Whether this rank is to own the rows of a node of the first body; true on one rank.
  std::function<bool(int body, GlobalOrdinal node)> isMine;
};

/// A linear equation between displacements: Σ directionᵀu = value over its terms.
struct Equation {
  struct Term {
    int body;
    GlobalOrdinal node;
    Eigen::Vector3d direction; ///< in space, of any length but 0
  };
  std::vector<Term> terms; ///< at least one
  double value = 0;
  std::string name{};   ///< for messages
  double stiffness = 0; ///< of a spring (compliance 1/stiffness of its row); 0: none
};

/// The tangents of a contact's nodes, perpendicular to each other and to d, or to what of d lies in a plane
/// of symmetry (ContactLayout::slidingNormalAt); there one of them is across the plane, if that is along an
/// axis of space or like the first such plane. From node to node they turn no more than d does where that is
/// possible: rows may combine several nodes.
class ContactTangents {
public:
  explicit ContactTangents(const ContactLayout& contact); ///< keeps a reference
  /// Of the place of a node with a row; in the plane the second is along z.
  [[nodiscard]] std::array<Eigen::Vector3d, 2> at(std::size_t place) const;

private:
  [[nodiscard]] bool isApart(const Eigen::Vector3d& axis) const;

  const ContactLayout& contact_;
  Eigen::Vector3d axis_; ///< across a plane of symmetry, or that of space which is farthest from all d
};

/// dᵀ(u_first − u_second) ≤ gap for all rows of all contacts. A node that supports hold in the row's
/// direction has no entry but those of its prescribed values. Collective.
/// \param contacts   the same on all ranks
/// \param equations  likewise; their rows follow those of contacts. The rank has a row that is to own those
/// of its first term's node
decomposition::ConstraintMatrix contactMatrix(const std::vector<ContactLayout>& contacts,
                                              const NodeUnknowns& unknowns, const RCP<const Comm>& comm,
                                              const std::vector<Equation>& equations = {});

/// Rows of friction beside those of contacts that have it (ContactLayout::firstFriction): tᵀ(u_first −
/// u_second) is what they slip. Collective.
decomposition::FrictionRows frictionRows(const std::vector<ContactLayout>& contacts,
                                         const NodeUnknowns& unknowns, const RCP<const Comm>& comm);

} // namespace epafi::contact
