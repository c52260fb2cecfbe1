#pragma once

/// Integrals of products of shape functions over what two surfaces, meshed apart, have in common: what
/// mortars are made of.
///
/// Facets of the second surface that may lie across one of the first are found by their bounding boxes in a
/// tree. Both are seen along the first facet's normal, clipped against each other there (in space convex
/// polygons, in the plane intervals), and what is left is cut into simplices with a Gauss rule: exact for
/// straight simplices and parallelograms, to round-off for other straight facets, and with an error that a
/// finer mesh takes away for curved ones (Puso, *Int. J. Numer. Meth. Engng* 59 (2004); Popp, Gitterle, Gee,
/// Wall, *ibid.* 83 (2010)).

#include "epafi/contact/ContactTerms.hpp"
#include "epafi/contact/SurfaceNodes.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::contact {

/// The integrals over one facet of the first surface, as far as the second covers it; N its shape functions.
/// Of solids of revolution 2πr is part of all of them.
struct MortarFacet {
  std::size_t facet = 0;  ///< of the first surface
  double whole = 0;       ///< area of all of it
  double area = 0;        ///< of what is covered
  double cosine = 1;      ///< of the angle between its normal and that of the facet which it faces best
  double deepest = 0;     ///< largest overlap
  Eigen::VectorXd shares; ///< ∫N
  Eigen::MatrixXd mass;   ///< ∫NNᵀ
  /// With a facet of the second surface, N² its shape functions.
  struct Across {
    std::size_t facet;
    Eigen::MatrixXd coupling; ///< ∫N(N²)ᵀ
  };
  std::vector<Across> across;
  std::vector<char>
      isReached; ///< of each node of the facet: whether the other surface lies across it, its rim included
};

/// A surface and where its nodes lie; keeps references.
struct PlacedSurface {
  const mesh::Surface& surface;
  const NodePoints& pointAt;
};

/// The facets of the first surface that are covered somewhere, ascending. A facet that several layers of the
/// other surface lie across meets the nearest one. Overlaps may be deeper than facets are large where they
/// are so around, from facet to facet, or where no facets of the two surfaces are nearer; else what lies
/// there is the other's far side. Not collective. \throws InputError if nothing is covered, with the reason:
/// the surfaces face away from each other, are farther apart than `distance`, overlap deeper than a body is
/// thick, or miss each other; or if a facet is folded.
std::vector<MortarFacet> mortarIntegrals(const ContactTerms& terms, const PlacedSurface& first,
                                         const PlacedSurface& second);

} // namespace epafi::contact
