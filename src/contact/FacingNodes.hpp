#pragma once

/// Nodes of two surfaces that face each other one by one.

#include "epafi/contact/ContactTerms.hpp"
#include "epafi/contact/RowAreas.hpp"
#include "epafi/contact/SurfaceNodes.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace epafi::contact {

/// For each node of a surface the place of the node of the other that it faces, or `alone`.
struct FacingNodes {
  static constexpr std::size_t alone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> partner;
  /// Of each facet of the first surface, whether its nodes face those of one facet of the other, however far
  /// away.
  std::vector<char> isCommon;
};

/// Pairs of nodes, 𝒪(n log n). Not collective.
FacingNodes facingNodes(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second);

/// Whether pairs of nodes say all that is to be said: where the surfaces face each other, however far they
/// are apart, nodes and facets do so one by one.
bool areAlike(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second);

/// Faces at a sharp bend whose normals' cosines with the other side's differ by less face it alike.
constexpr double asGood = 0.25;

/// How two nodes face each other.
struct Facing {
  Eigen::Vector3d normal; ///< the mean of the first's and the other's, reversed, of length 1
  double cosine;          ///< of the angle between both
  bool isBent;            ///< whether one of them is the mean of several faces
};

/// By the normals of both surfaces; where one bends sharply, of the faces that face the other side best.
Facing facingOf(const SurfaceNodes& first, std::size_t i, const SurfaceNodes& second, std::size_t j);

/// ∫N_a over the facets that a predicate (number of a facet, place of its node) takes; of nodes that have
/// none over all of theirs.
RowAreas areasOf(const ContactTerms& contact, const SurfaceNodes& surface,
                 const std::function<bool(std::size_t facet, std::size_t node)>& counts);

/// \throws InputError if both surfaces have nodes left over that are near the other one, or two nodes face
/// the same one.
void requireMatch(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                  const FacingNodes& pairs);

} // namespace epafi::contact
