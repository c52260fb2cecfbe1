#pragma once

/// Sparse factorisation by a serial solver of Amesos2, on a communicator of this rank alone.

#include "epafi/direct/SpdFactor.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::direct {

/// The solvers of Amesos2 that this build of Trilinos has and that factorise matrices of a single rank.
std::vector<std::string> amesosSolvers();

/// See Factorizer. \param solver  one of `amesosSolvers()`. \throws whatever Amesos2 throws.
std::unique_ptr<SpdFactor> factorizeByAmesos(const SparseMatrix& matrix, const std::vector<int>& kept,
                                             const std::string& solver);

} // namespace epafi::direct
