#pragma once

/// Stresses inside one element that balance given tractions on its facets and a constant load exactly: what
/// guaranteed error bounds are made of. The element is cut into the simplices between its facets, or the
/// triangles that make up a quadrilateral one (FacetFunctions.hpp), and its centre; on each of them the
/// stress is a polynomial of the element's order, its tractions agree between them (C. Johnson, B. Mercier,
/// *Numer. Math.* 30 (1978); M. Křížek, *Apl. Mat.* 27 (1982); in space arXiv 2403.13189). Symmetric stresses
/// of elastic bodies are multiplied with the thickness; a membrane has its flux.
///
/// *Data* of an element are, facet by facet and node by node, the moments ∫ t N_a of the outward tractions t,
/// components in space, and then the load per area or volume: numData() numbers. A stress exists where they
/// are in balance, forces and moments.

#include "epafi/fem/FacetFunctions.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::fem {

/// What holds on the reference element, for elements of one kind and order, membranes or elastic bodies.
class CompositeCell {
public:
  /// Made once for each. \param components  1 of membranes, 2 and 3 of elastic bodies
  static const CompositeCell& of(mesh::CellType type, int components);

  [[nodiscard]] int numData() const { return numTractions() + components; }
  [[nodiscard]] int numTractions() const { return numFacets * perFacet * components; }

  mesh::CellType type;
  int components, dimension, numFluxes, numFacets, perFacet;
  std::vector<Eigen::MatrixXd> parts; ///< corners of each simplex, a column each
  /// A column for each of the data, then those that need none: numbers at the nodes of each part, component
  /// by component (x, y; xx, yy, xy; xx, yy, zz, xy, yz, zx).
  Eigen::MatrixXd stresses;
  std::vector<Eigen::MatrixXd> products; ///< ∫ of these, for each pair k ≤ l of components
  Eigen::VectorXd shares;                ///< ∫ N_a
  // Points that are enough for moments of tractions, facet by facet:
  Eigen::MatrixXd facetGradients; ///< of the element's shape functions, a column each
  Eigen::MatrixXd facetShares;    ///< of one facet, weights times the facet's functions N_a, a column each

private:
  CompositeCell(mesh::CellType cellType, int numComponents);
};

/// Place of the component ij among the numbers of a flux.
int placeInFlux(int i, int j, int components);
/// The flux through a facet with a normal, components × numFluxes, of a membrane or an elastic body.
Eigen::MatrixXd throughFacet(const Eigen::VectorXd& normal, int components);

} // namespace epafi::fem
