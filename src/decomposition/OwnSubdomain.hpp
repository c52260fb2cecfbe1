#pragma once

/// From an application's subdomain to one in the order of its nodes, prescribed unknowns taken out.

#include "epafi/decomposition/SubdomainMatrix.hpp"
#include "epafi/decomposition/Substructures.hpp"

#include <Eigen/Core>

#include <vector>

namespace epafi::decomposition {

/// What is kept of a SubdomainMatrix; vectors are in its order.
struct OwnSubdomain {
  std::vector<GlobalOrdinal> unknowns;
  std::vector<int> position;       ///< of each unknown among nodes × components
  std::vector<int> row;            ///< its number among the free unknowns, −1 if prescribed
  Eigen::VectorXd load, heldForce; ///< f^s, and K^s u of the prescribed values u alone
  Eigen::VectorXd prescribed;      ///< u, 0 where free
};

/// Enters body, nodes, positions and prescribed values; takes the matrix's load. Precondition: the matrix is
/// sound. Not collective.
OwnSubdomain takeSubdomain(SubdomainMatrix& matrix, int components, Subdomain& subdomain, SubdomainData& data,
                           NodalSubdomain& nodal);

/// K^s without the rows and columns of prescribed unknowns, in the order of positions. Not collective.
SparseMatrix freeStiffness(const SparseMatrix& stiffness, const OwnSubdomain& own);

/// Loads, reactions and energies of the data, from what is kept; unknowns are values of nodes. Not
/// collective.
void refresh(const OwnSubdomain& own, SubdomainData& data);

} // namespace epafi::decomposition
