#pragma once

/// What all ranks do together: errors that they agree on, so that a rank in trouble never leaves the others
/// waiting in a collective call; sums and extrema of numbers; values gathered.

#include "epafi/base/Types.hpp"

#include <Teuchos_CommHelpers.hpp>

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
/// with the same type (InputError, SolvabilityError, or Error for all else) and the same text (sentenceOf
/// what is no error of Epafi's).
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

/// Σ of the values of the ranks before this one. Not by Teuchos::scan, which makes of a lack of memory an
/// exception without a word. Collective.
GlobalOrdinal sumBefore(const Comm& comm, GlobalOrdinal mine);

namespace detail {
/// Of one number of each rank, by `type`. Collective.
template <class Number>
Number reduced(const Comm& comm, Teuchos::EReductionType type, Number value) {
  Number result{};
  Teuchos::reduceAll(comm, type, 1, &value, &result);
  return result;
}

} // namespace detail

/// Sum, maximum or minimum of one number over the ranks. Collective.
template <class Number>
requires std::is_arithmetic_v<Number> Number sumOverRanks(const Comm& comm, Number value) {
  return detail::reduced(comm, Teuchos::REDUCE_SUM, value);
}
/// Likewise.
template <class Number>
Number maxOverRanks(const Comm& comm, Number value) {
  return detail::reduced(comm, Teuchos::REDUCE_MAX, value);
}
/// Likewise.
template <class Number>
Number minOverRanks(const Comm& comm, Number value) {
  return detail::reduced(comm, Teuchos::REDUCE_MIN, value);
}

/// Whether it holds on one rank or more. Collective.
bool holdsAnywhere(const Comm& comm, bool here);

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

/// The values of all ranks, rank after rank, on every rank. For data of the coarse problem's size only.
///
/// \param values  a vector, span or array of what may be copied byte by byte: numbers, or structs of them.
/// Any number of them, also none. Collective.
template <class Values>
auto gatherOnAll(const Comm& comm, const Values& values) {
  return detail::gathered(comm, values, true);
}

/// The same on rank 0 alone; empty on the others. Collective.
template <class Values>
auto gatherOnFirst(const Comm& comm, const Values& values) {
  return detail::gathered(comm, values, false);
}

} // namespace epafi
