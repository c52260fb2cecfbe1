#pragma once

#include "epafi/base/Types.hpp"

/// A membrane over an obstacle, min ∫ ½|∇u|² + 8u over u ≥ −0.3, u = 0 on the border of the unit square, as
/// min ½uᵀAu − bᵀu, u ≥ l: n × n unknowns, the five-point Laplacian and the load times h².
struct Obstacle {
  epafi::RCP<epafi::CrsMatrix> a;  ///< A, symmetric positive definite
  epafi::RCP<epafi::Vector> load;  ///< b
  epafi::RCP<epafi::Vector> floor; ///< l
};

/// Every rank fills the rows that it owns. Collective.
Obstacle makeObstacle(epafi::GlobalOrdinal n, const epafi::RCP<const epafi::Comm>& comm);
