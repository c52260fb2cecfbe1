#pragma once

/// Averages along the edges of subdomains as coarse unknowns: in space, where corners alone do not make
/// FETI-DP scalable (Klawonn, Widlund, Dryja, *SIAM J. Numer. Anal.* 40 (2002)), and for elastic bodies in
/// the plane, where they take 40 % of the iterations away (22 become 14 products with F for two blocks, 1/H =
/// 8, H/h = 8; METIS parts 25 become 16). Membranes in the plane do without: their corners suffice, and the
/// coarse problem stays small; but for bodies of several clusters (Clusters.hpp), whose corners at other
/// clusters are no crosspoints. Made by a change of basis (Klawonn, Widlund, *Comm. Pure Appl. Math.* 59
/// (2006); Li, Widlund, *Int. J. Numer. Meth. Engng* 66 (2006)).
///
/// On an edge of m nodes the unknowns of one component become the average a and m − 1 deviations ũ_i from it:
///   u_i = ũ_i + a for all but the carrier,   u_carrier = a − Σ ũ_i,   in short u = T ũ.
/// a takes the carrier's place and belongs to the coarse problem; the deviations are glued like values of
/// nodes.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/SharedNodes.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// An entry of B that is still named by its global row.
struct RowEntry {
  GlobalOrdinal row; ///< index of the multiplier
  int unknown;
  double coefficient;
};

/// The average of u along an edge of a subdomain, component by component, in the place of its carrier's
/// values.
struct EdgeAverage {
  std::size_t carrier = 0;         ///< place of a node
  std::vector<std::size_t> others; ///< places of the other nodes, ascending
};

/// Whether bodies of these dimensions and unknowns a node have averages in any case.
bool hasEdgeAverages(const Substructures& all);

/// The averages of a subdomain: an edge are the free nodes that just the same subdomains share, three or more
/// in space and two in the plane, crosspoints left out, if they are two or more. All subdomains at an edge
/// choose the same carrier.
std::vector<EdgeAverage> findEdgeAverages(const Substructures& all, const SharedNodes& shared,
                                          std::size_t subdomain, const std::vector<char>& isCrosspoint);

/// The averages of a subdomain by their unknowns, component by component.
std::vector<Average> averagesOf(const Substructures& all, std::size_t subdomain,
                                const std::vector<EdgeAverage>& edges);

/// Rows that act on u become such that act on ũ.
std::vector<RowEntry> inBasisOf(const std::vector<Average>& averages, std::vector<RowEntry> rows);

/// Tᵀ f.
Eigen::VectorXd loadInBasisOf(const std::vector<Average>& averages, Eigen::VectorXd load);

/// T⁻¹ R.
Eigen::MatrixXd kernelInBasisOf(const std::vector<Average>& averages, Eigen::MatrixXd kernel);

/// Tᵀ K T, of which subdomains with equal K and equal averages share one. Nothing is collective.
class AverageBasis {
public:
  std::shared_ptr<const SparseMatrix> changed(const std::vector<Average>& averages,
                                              const std::shared_ptr<const SparseMatrix>& nodal);

private:
  struct Known {
    std::shared_ptr<const SparseMatrix> nodal, changed;
    std::vector<Average> averages;
  };
  std::vector<Known> known_; ///< the last few
};

} // namespace epafi::decomposition
