#pragma once

/// Cholesky factorisation by CHOLMOD (Chen, Davis, Hager, Rajamanickam, *ACM Trans. Math. Softw.* 35 (2008)).

#include "epafi/direct/SpdFactor.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::direct {

/// Ordering and elimination tree of a pattern, with the kept unknowns last; shared by all matrices that have
/// it.
class CholmodPattern;

/// Orders by constrained approximate minimum degree. See Factorizer for the arguments.
std::shared_ptr<const CholmodPattern> analyzePattern(const SparseMatrix& matrix,
                                                     const std::vector<int>& kept);
/// Whether the pattern is that of `matrix` with the same unknowns kept, in the same order.
bool fits(const CholmodPattern& pattern, const SparseMatrix& matrix, const std::vector<int>& kept);

/// The pattern of a factor that CHOLMOD made; null of others.
std::shared_ptr<const CholmodPattern> patternOf(const SpdFactor& factor);

/// \throws Error if the matrix is not positive definite.
std::unique_ptr<SpdFactor> factorizeByCholmod(const SparseMatrix& matrix,
                                              std::shared_ptr<const CholmodPattern> pattern,
                                              const std::string& what);

} // namespace epafi::direct
