#pragma once

/// What all ranks do together: errors that they agree on, so that a rank in trouble never leaves the others waiting in a
/// collective call; sums and extrema of numbers; values gathered.

#include "epafi/base/Types.hpp"

#include <Teuchos_Comm.hpp>

#include <cstddef>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
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
void sumOverRanks(const Comm& comm, std::span<GlobalOrdinal> values); ///< likewise
void sumOverRanks(const Comm& comm, std::span<int> values);           ///< likewise

/// Sum, maximum or minimum of one value over the ranks. Collective.
double sumOverRanks(const Comm& comm, double value);
GlobalOrdinal sumOverRanks(const Comm& comm, GlobalOrdinal value); ///< likewise
int sumOverRanks(const Comm& comm, int value);                     ///< likewise
double maxOverRanks(const Comm& comm, double value);               ///< likewise
GlobalOrdinal maxOverRanks(const Comm& comm, GlobalOrdinal value); ///< likewise
int maxOverRanks(const Comm& comm, int value);                     ///< likewise
double minOverRanks(const Comm& comm, double value);               ///< likewise
GlobalOrdinal minOverRanks(const Comm& comm, GlobalOrdinal value); ///< likewise
int minOverRanks(const Comm& comm, int value);                     ///< likewise

/// Whether it holds on one rank or more. Collective.
bool holdsAnywhere(const Comm& comm, bool here);

/// The values of all ranks, rank after rank, on every rank. For data of the coarse problem's size only.
///
/// \param values  a vector, span or array of what may be copied byte by byte: numbers, or structs of them. Any number of
/// them, also none. Collective.
template <class Values>
auto gatherOnAll(const Comm& comm, const Values& values);

/// The same on rank 0 alone; empty on the others. Collective.
template <class Values>
auto gatherOnFirst(const Comm& comm, const Values& values);

namespace detail {

/// How many values each rank has. Collective.
std::vector<int> countsOfRanks(const Comm& comm, std::size_t mine);

/// Puts counts[r] values of `size` bytes from each rank r into `all`, on all ranks or on rank 0. Collective.
void gather(const Comm& comm, const void* mine, std::span<const int> counts, std::size_t size, bool isForAll,
            void* all);

/// The values of all ranks, on all or on rank 0. Collective.
template <class Values>
auto gathered(const Comm& comm, const Values& values, bool isForAll) {
  using Value = std::remove_cvref_t<decltype(*std::data(values))>;
  static_assert(std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value>);
  const std::vector<int> counts = countsOfRanks(comm, std::size(values));
  std::vector<Value> all;
  if (isForAll || comm.getRank() == 0)
    all.resize(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
  gather(comm, std::data(values), counts, sizeof(Value), isForAll, all.data());
  return all;
}

} // namespace detail

template <class Values>
auto gatherOnAll(const Comm& comm, const Values& values) {
  return detail::gathered(comm, values, true);
}

template <class Values>
auto gatherOnFirst(const Comm& comm, const Values& values) {
  return detail::gathered(comm, values, false);
}

} // namespace epafi
