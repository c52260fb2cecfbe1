#pragma once

/// Algebraic multigrid as a preconditioner, by MueLu. This is the one place that knows MueLu: its headers
/// take long to compile.

#include "epafi/base/Types.hpp"

namespace epafi::drivers {

/// One symmetric V-cycle of smoothed aggregation for `a`: symmetric positive definite if `a` is. Shares the
/// matrix.
/// \param a  scalar unknowns, constants in the near kernel
/// Collective.
RCP<const Operator> makeMultigrid(const RCP<CrsMatrix>& a);

/// The same for the face of the free entries: rows and columns of all others hold nothing but their diagonal.
/// \param freeIndicator  1 where an entry is free, else 0; on the matrix's map
/// Returns null if no entry is free: there is nothing to precondition.
/// Collective.
RCP<const Operator> makeFaceMultigrid(const RCP<CrsMatrix>& a, const Vector& freeIndicator);

/// `a` with rows and columns of the entries that are not free replaced by their diagonal. Collective.
RCP<CrsMatrix> restrictedToFace(const CrsMatrix& a, const Vector& freeIndicator);

} // namespace epafi::drivers
