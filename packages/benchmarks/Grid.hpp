#pragma once

/// A rectangle with a border of given values and nx × ny unknowns inside, and matrices with a five-point
/// stencil on it.

#include "epafi/base/Types.hpp"

#include <array>
#include <functional>

namespace epafi::benchmarks {

/// The unknown (i, j), 0 ≤ i < nx, 0 ≤ j < ny, has the global index i + nx·j and stands at (left + (i+1) hx,
/// bottom + (j+1) hy); the border lines are i = −1, i = nx, j = −1 and j = ny. With ny = 1 and a stencil
/// without south and north it is a line.
struct Grid {
  int nx = 0, ny = 0;
  double left = 0, bottom = 0;
  double hx = 0, hy = 0;

  /// n × n unknowns in (left, right) × (bottom, top).
  /// \throws InputError if n < 1. Not collective.
  static Grid square(int n, double left, double right, double bottom, double top);
  [[nodiscard]] double x(int i) const { return left + (i + 1) * hx; }
  [[nodiscard]] double y(int j) const { return bottom + (j + 1) * hy; }
  [[nodiscard]] GlobalOrdinal size() const { return static_cast<GlobalOrdinal>(nx) * ny; }
  /// Column i and row j of an unknown.
  [[nodiscard]] std::array<int, 2> place(GlobalOrdinal unknown) const {
    return {static_cast<int>(unknown % nx), static_cast<int>(unknown / nx)};
  }
  /// Tpetra's linear map: rows of the grid one after the other, as even as can be; ranks without unknowns are
  /// allowed. Collective.
  [[nodiscard]] RCP<const Map> map(const RCP<const Comm>& comm) const;
  /// values(i, j) at every unknown. Not collective.
  [[nodiscard]] RCP<Vector> vector(const RCP<const Map>& map,
                                   const std::function<double(int i, int j)>& values) const;
};

/// One row of a matrix. A weight of 0 makes no entry.
struct Stencil {
  double centre = 0, west = 0, east = 0, south = 0, north = 0;
};

/// A u = b on a grid.
struct FivePointSystem {
  RCP<CrsMatrix> matrix; ///< fill-complete
  RCP<Vector> rightHandSide;
};

/// Each rank fills its own rows.
/// \param stencil  row (i, j); the matrix is symmetric if east(i, j) = west(i+1, j) and north(i, j) =
/// south(i, j+1)
/// \param load  right-hand side at (i, j), where u is not 0 on the border with what its weights there bring
/// Collective.
FivePointSystem assembleFivePoint(const Grid& grid, const RCP<const Comm>& comm,
                                  const std::function<Stencil(int i, int j)>& stencil,
                                  const std::function<double(int i, int j)>& load);

/// The stencil of −Δ times hx hy at (i, j): linear elements on triangles.
/// \param borderWeight  factor of the edges that end on the border: 1, or ½ as in CUTEst (see
/// PublishedProblems.hpp)
Stencil laplaceStencil(const Grid& grid, int i, int j, double borderWeight = 1);

/// The bilinear interpolation from one grid to another of the same rectangle, 0 on the border: (fine size) ×
/// (coarse size), not more than four entries a row. The grids need not be nested. Each rank fills the rows of
/// its fine unknowns.
/// \param coarse, fine        with ny > 1
/// \param coarseMap, fineMap  of the unknowns
/// Collective.
RCP<CrsMatrix> bilinearInterpolation(const Grid& coarse, const RCP<const Map>& coarseMap, const Grid& fine,
                                     const RCP<const Map>& fineMap);

} // namespace epafi::benchmarks
