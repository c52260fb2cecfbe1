#pragma once

/// Averages along the edges of subdomains as coarse unknowns: in space, where corners alone do not make FETI-DP scalable
/// (Klawonn, Widlund, Dryja, *SIAM J. Numer. Anal.* 40 (2002)), and for elastic bodies in the plane, where they take 40 % of
/// the iterations away (22 become 14 products with F for two blocks, 1/H = 8, H/h = 8; METIS parts 25 become 16). Membranes
/// in the plane do without: their corners suffice, and the coarse problem stays small.
/// Made by a change of basis (Klawonn, Widlund, *Comm. Pure Appl. Math.* 59 (2006); Li, Widlund, *Int. J. Numer. Meth.
/// Engng* 66 (2006)).
///
/// On an edge of m nodes the unknowns of one component become the average a and m − 1 deviations ũ_i from it:
///   u_i = ũ_i + a for all but the carrier,   u_carrier = a − Σ ũ_i,   in short u = T ũ.
/// a takes the carrier's place and belongs to the coarse problem; the deviations are glued like values of nodes.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/Pieces.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// Whether bodies of so many dimensions and unknowns a node have averages.
bool hasEdgeAverages(int dimension, std::size_t components);

/// Fills the averages of a piece: an edge are the free nodes that just the same parts share, three or more in space and two
/// in the plane, crosspoints left out, if they are two or more. All pieces of an edge choose the same carrier.
/// Precondition: crosspoints are marked.
void findEdgeAverages(int dimension, std::size_t components, Piece& piece);

/// The averages of a piece by their unknowns, component by component.
std::vector<Average> averagesOf(const Piece& piece, std::size_t components);

/// Rows that act on u, from `first` on, become such that act on ũ.
void changeBasisOfRows(const std::vector<Average>& averages, std::size_t first, std::vector<RowEntry>& rows);

/// f becomes Tᵀ f.
void changeBasisOfLoad(const std::vector<Average>& averages, Eigen::VectorXd& load);

/// Tᵀ K T, of which the pieces with equal K and equal averages share one; Tᵀ f; T⁻¹ R. Nothing is collective.
class AverageBasis {
public:
  void change(const std::vector<Average>& averages, Piece& piece);
  /// Tᵀ K T alone.
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
