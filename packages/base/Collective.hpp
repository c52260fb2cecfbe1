#pragma once

/// Errors that all ranks agree on: a rank in trouble never leaves the others waiting in a collective call.

#include "epafi/base/Types.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace epafi {

/// Runs `work` on every rank. If it throws anywhere, every rank throws the error of the lowest failing rank,
/// with the same type (InputError, SolvabilityError, or Error for all else) and the same text (sentenceOf what is no error
/// of Epafi's).
///
/// \param work  must contain no collective call itself, or only ones that all ranks reach before any can
/// throw. Collective.
void collectively(const Comm& comm, const std::function<void()>& work);

/// The text of the lowest rank whose text is not empty, on every rank; empty if all are. Collective.
std::string agreedText(const Comm& comm, const std::string& text);

/// Sums `values` over the ranks, in place. Collective.
void sumOverRanks(const Comm& comm, std::span<double> values);

/// Sum, maximum or minimum of one value over the ranks. Collective.
double sumOverRanks(const Comm& comm, double value);
GlobalOrdinal sumOverRanks(const Comm& comm, GlobalOrdinal value); ///< likewise
double maxOverRanks(const Comm& comm, double value);               ///< likewise
double minOverRanks(const Comm& comm, double value);               ///< likewise

/// The values of all ranks, rank after rank, on every rank. For data of the coarse problem's size only.
/// Collective.
std::vector<double> gatherOnAll(const Comm& comm, std::span<const double> values);

/// The same on rank 0 alone; empty on the others. Collective.
std::vector<double> gatherOnFirst(const Comm& comm, std::span<const double> values);

} // namespace epafi
