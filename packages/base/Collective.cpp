#include "epafi/base/Collective.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/RawCommunicator.hpp"

#include <cstring>

namespace epafi {
namespace {

enum class Failure : int { none = 0, other = 1, input = 2, noSolution = 3, notUnique = 4 };

[[noreturn]] void raise(Failure kind, const std::string& text) {
  switch (kind) {
  case Failure::input:
    throw InputError(text);
  case Failure::noSolution:
    throw SolvabilityError(SolvabilityError::Kind::noSolution, text);
  case Failure::notUnique:
    throw SolvabilityError(SolvabilityError::Kind::notUnique, text);
  default:
    throw Error(text);
  }
}

template <class T>
void sumInPlace(const Comm& comm, std::span<T> values) {
  if (values.empty() || comm.getSize() == 1)
    return;
  const std::vector<T> mine(values.begin(), values.end());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(values.size()), mine.data(), values.data());
}

/// The lowest rank where `holds`; the number of ranks if it holds nowhere.
int lowestRank(const Comm& comm, bool holds) {
  return minOverRanks(comm, holds ? comm.getRank() : comm.getSize());
}

/// The text of rank `root` on every rank.
std::string broadcastText(const Comm& comm, int root, std::string text) {
  int size = static_cast<int>(text.size());
  Teuchos::broadcast(comm, root, 1, &size);
  text.resize(size);
  if (size > 0)
    Teuchos::broadcast(comm, root, size, text.data());
  return text;
}

} // namespace

void collectively(const Comm& comm, const std::function<void()>& work) {
  Failure mine = Failure::none;
  std::string text;
  try {
    work();
  } catch (const InputError& error) {
    mine = Failure::input;
    text = error.what();
  } catch (const SolvabilityError& error) {
    mine = error.kind() == SolvabilityError::Kind::noSolution ? Failure::noSolution : Failure::notUnique;
    text = error.what();
  } catch (const std::exception& error) {
    mine = Failure::other;
    text = sentenceOf(error, comm.getRank());
  } catch (...) {
    mine = Failure::other;
    text = "an unknown error occurred on rank " + std::to_string(comm.getRank());
  }

  const int first = lowestRank(comm, mine != Failure::none);
  if (first == comm.getSize())
    return;
  int kind = static_cast<int>(mine);
  Teuchos::broadcast(comm, first, 1, &kind);
  raise(static_cast<Failure>(kind), broadcastText(comm, first, text));
}

std::string agreedText(const Comm& comm, const std::string& text) {
  const int first = lowestRank(comm, !text.empty());
  return first == comm.getSize() ? std::string() : broadcastText(comm, first, text);
}

void sumOverRanks(const Comm& comm, std::span<double> values) {
  sumInPlace(comm, values);
}
void sumOverRanks(const Comm& comm, std::span<GlobalOrdinal> values) {
  sumInPlace(comm, values);
}
void sumOverRanks(const Comm& comm, std::span<int> values) {
  sumInPlace(comm, values);
}

bool holdsAnywhere(const Comm& comm, bool here) {
  return lowestRank(comm, here) < comm.getSize();
}

namespace detail {

std::vector<int> countsOfRanks(const Comm& comm, std::size_t mine) {
  std::vector<int> counts(comm.getSize());
  const int count = static_cast<int>(mine);
  Teuchos::gatherAll(comm, 1, &count, comm.getSize(), counts.data());
  return counts;
}

void gather(const Comm& comm, const void* mine, std::span<const int> counts, std::size_t size, bool isForAll,
            void* all) {
  const int count = counts[comm.getRank()];
  if (comm.getSize() == 1) {
    if (count > 0)
      std::memcpy(all, mine, count * size);
    return;
  }
  std::vector<int> offsets(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  MPI_Datatype type = MPI_DATATYPE_NULL; // of one value, so that counts of bytes need not fit an int
  MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  if (isForAll)
    MPI_Allgatherv(mine, count, type, all, counts.data(), offsets.data(), type, rawCommunicator(comm));
  else
    MPI_Gatherv(mine, count, type, all, counts.data(), offsets.data(), type, 0, rawCommunicator(comm));
  MPI_Type_free(&type);
}

} // namespace detail
GlobalOrdinal sumBefore(const Comm& comm, GlobalOrdinal mine) {
  if (comm.getSize() == 1)
    return 0;
  long long sum = 0;
  const long long own = mine;
  MPI_Scan(&own, &sum, 1, MPI_LONG_LONG, MPI_SUM, rawCommunicator(comm));
  return sum - own;
}

} // namespace epafi
