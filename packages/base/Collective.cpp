#include "epafi/base/Collective.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_DefaultMpiComm.hpp>

#include <algorithm>
#include <numeric>
#include <string>

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
T reduced(const Comm& comm, Teuchos::EReductionType type, T value) {
  T result{};
  Teuchos::reduceAll(comm, type, 1, &value, &result);
  return result;
}

/// The lowest rank where `holds`; the number of ranks if it holds nowhere.
int lowestRank(const Comm& comm, bool holds) {
  return reduced(comm, Teuchos::REDUCE_MIN, holds ? comm.getRank() : comm.getSize());
}

/// The text of rank `root` on every rank.
std::string broadcastText(const Comm& comm, int root, std::string text) {
  int size = static_cast<int>(text.size());
  Teuchos::broadcast(comm, root, 1, &size);
  text.resize(static_cast<std::size_t>(size));
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
  if (values.empty() || comm.getSize() == 1)
    return;
  const std::vector<double> mine(values.begin(), values.end());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(values.size()), mine.data(), values.data());
}

double sumOverRanks(const Comm& comm, double value) {
  return reduced(comm, Teuchos::REDUCE_SUM, value);
}

GlobalOrdinal sumOverRanks(const Comm& comm, GlobalOrdinal value) {
  return reduced(comm, Teuchos::REDUCE_SUM, value);
}

double maxOverRanks(const Comm& comm, double value) {
  return reduced(comm, Teuchos::REDUCE_MAX, value);
}

double minOverRanks(const Comm& comm, double value) {
  return reduced(comm, Teuchos::REDUCE_MIN, value);
}

std::vector<double> gatherOnAll(const Comm& comm, std::span<const double> values) {
  // Blocks of equal length, padded: Teuchos gathers no others.
  const auto ranks = static_cast<std::size_t>(comm.getSize());
  const auto mine = static_cast<int>(values.size());
  int longest = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &mine, &longest);
  const auto block = static_cast<std::size_t>(longest) + 1;
  std::vector<double> padded(block), all(block * ranks);
  padded[0] = mine;
  std::copy(values.begin(), values.end(), padded.begin() + 1);
  Teuchos::gatherAll(comm, static_cast<int>(block), padded.data(), static_cast<int>(all.size()), all.data());

  std::vector<double> result;
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(rank * block) + 1;
    result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(all[rank * block]));
  }
  return result;
}

std::vector<double> gatherOnFirst(const Comm& comm, std::span<const double> values) {
  const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(&comm);
  if (mpi == nullptr || comm.getSize() == 1)
    return {values.begin(), values.end()};
  const MPI_Comm raw = *mpi->getRawMpiComm();
  const auto ranks = static_cast<std::size_t>(comm.getSize());
  const auto mine = static_cast<int>(values.size());
  std::vector<int> counts(ranks), offsets(ranks, 0);
  MPI_Gather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, raw);
  std::vector<double> all;
  if (comm.getRank() == 0) {
    std::partial_sum(counts.begin(), counts.end() - 1, offsets.begin() + 1);
    all.resize(static_cast<std::size_t>(offsets.back()) + static_cast<std::size_t>(counts.back()));
  }
  MPI_Gatherv(values.data(), mine, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, 0, raw);
  return all;
}

} // namespace epafi
