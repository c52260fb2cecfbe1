#include "epafi/decomposition/Substructures.hpp"

namespace epafi::decomposition {

void diagonalAt(const SparseMatrix& matrix, std::span<const int> unknowns, std::span<double> stiffness) {
  for (std::size_t c = 0; c < unknowns.size(); ++c)
    stiffness[c] = unknowns[c] < 0 ? 0 : matrix.coeff(unknowns[c], unknowns[c]);
}

} // namespace epafi::decomposition
