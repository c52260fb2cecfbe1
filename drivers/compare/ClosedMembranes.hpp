#pragma once

/// The membranes of the model problem once the contact zone is known: the least that any active set method has to
/// solve at least once, and what a linear solver is measured by.

#include <vector>

namespace epafi::drivers {

/// Ku = f with all of K stored, row by row, columns ascending: compressed rows and columns alike.
struct SparseSystem {
  std::vector<int> rowStarts; ///< n + 1
  std::vector<int> columns;
  std::vector<double> values;
  std::vector<double> load; ///< n

  [[nodiscard]] int size() const { return static_cast<int>(load.size()); }
  /// Ku.
  [[nodiscard]] std::vector<double> product(const std::vector<double>& u) const;
};

/// Which membranes: see scene::modelProblem, whose bodies, supports and loads these are.
struct MembraneChoice {
  bool coercive = true;
  int elements = 0; ///< 1/h: a multiple of 4
  int closedNodes =
      0; ///< the lowest so many nodes of x = 1 are one node of both bodies, the others two free ones
};

/// Nodes on supports are eliminated. If `closedNodes` is the number of nodes in contact, u is the solution of the
/// contact problem: on both model problems the contact zone begins at (1,0) and is in one piece.
/// Precondition: 0 < closedNodes ≤ elements + 1.
SparseSystem closedMembranes(const MembraneChoice& choice);

} // namespace epafi::drivers
