#pragma once

/// One subdomain as an application has it: its stiffness, not yet summed with that of its neighbours, and
/// where its unknowns lie in the whole.

#include "epafi/base/Types.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"

#include <Eigen/Core>

#include <span>
#include <utility>
#include <vector>

namespace epafi::decomposition {

/// K^s and f^s of one subdomain. Unknowns are numbered through all subdomains: those of one node follow each
/// other, node = number / components, component = number % components; an unknown that several subdomains
/// share has the same number in each, and K = Σ K^s, f = Σ f^s. Numbers may have holes (supports that the
/// application has eliminated), their order is free. Eigen 3.4 copies matrices: move what is large.
struct SubdomainMatrix {
  int body = 0;                        ///< index into the bodies that UnassembledProblem was given
  std::vector<GlobalOrdinal> unknowns; ///< n: global number of each row of K^s, ≥ 0, none twice
  SparseMatrix stiffness; ///< K^s, n × n, symmetric positive semidefinite, both triangles stored
  Eigen::VectorXd load;   ///< f^s, n
  Eigen::MatrixXd
      coordinates; ///< n × dimension: the place of each unknown's node, in the length of the model
  /// n × k, k the same in all subdomains of a body: motions among which are those that supports leave free,
  /// whatever the supports are. Empty: the rigid motions, of `coordinates`, or constants if a node has not as
  /// many unknowns as dimensions.
  Eigen::MatrixXd nearKernel;
  /// Unknowns of this subdomain that supports prescribe, and their values; they have rows in K^s all the
  /// same. All subdomains that share one say so.
  std::vector<std::pair<GlobalOrdinal, double>> prescribed;
  /// Nodes that are to be crosspoints beside those that are chosen; naming them in one subdomain is enough.
  std::vector<GlobalOrdinal> crosspoints;
};

/// Of compressed rows (0-based, `starts` has n + 1 entries), as C and Fortran codes keep them; the columns of
/// a row may come in any order, entries given twice are summed. \throws InputError if the arrays do not make
/// a square matrix.
SparseMatrix fromCompressedRows(std::span<const int> starts, std::span<const int> columns,
                                std::span<const double> values);

/// K^s and its unknowns of a Tpetra matrix that lies on this rank alone (its maps have a communicator of one
/// rank): the row map's global indices are the numbers of the unknowns. Load and coordinates are left for the
/// caller to fill. Not collective. \throws InputError if the matrix is not fill-complete, not on one rank, or
/// has columns that are no rows.
SubdomainMatrix subdomainMatrix(const CrsMatrix& local);

/// The point in a row of coordinates; a coordinate that the space does not have is 0.
Point pointAt(const Eigen::MatrixXd& coordinates, Eigen::Index row);

/// Checks shapes, numbers, that coordinates and K^s are finite, and symmetry to 1e-10 of the largest entry of
/// K^s. \throws InputError that names the subdomain `where`. Not collective.
void requireSound(const SubdomainMatrix& matrix, int dimension, int components, int numBodies,
                  const std::string& where);

} // namespace epafi::decomposition
