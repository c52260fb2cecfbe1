#pragma once

/// Multipliers in a file, for a run to go on from, and the load steps that it has done.
///
/// The file is a text (checkpointHeader()), λ in the order of its rows, 8 bytes a number, the steps
/// (stepsText()), and a checksum of all that. It does not depend on the number of ranks. That it is no HDF5
/// has a reason: damaged files must end with a sentence, and what HDF5 does with them is not in our hands.

#include "epafi/output/Fingerprint.hpp"
#include "epafi/simulation/StepsDone.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace epafi::output {

struct Checkpoint {
  std::filesystem::path file;
  Fingerprint fingerprint;    ///< of the problem that λ belongs to
  std::vector<double> values; ///< λ on rank 0, finite; nothing on the others
  /// The load steps before that which λ is to begin, on all ranks; nothing: there are none.
  std::optional<simulation::StepsDone> steps;
};

/// The text that a file begins with: begins "Epafi checkpoint 4" and ends with an empty line.
/// \param length  of the text of load steps, in bytes
std::string checkpointHeader(const Fingerprint& fingerprint, std::size_t length = 0);

/// Fowler, Noll, Vo: FNV-1a, 64 bits, over pieces one after the other.
class Checksum {
public:
  /// The next piece.
  void add(const void* bytes, std::size_t size) {
    const auto* next = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i)
      value_ = (value_ ^ next[i]) * 0x100000001b3ULL;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; } ///< of all pieces so far

private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Writes λ; the file appears complete or not at all, and is on the disk then, not only on its way there.
/// Creates its directory. Rank 0 writes; it holds λ whole while it does.
/// \param lambda  on the problem's multiplierMap
/// \param steps   that are done; null: none. Rank 0's counts
/// Collective. \throws InputError if the directory cannot be made or written to, Error if writing fails; an
/// older file is untouched then.
void writeCheckpoint(const std::filesystem::path& file, const Fingerprint& fingerprint, const Vector& lambda,
                     const simulation::StepsDone* steps = nullptr);

/// Rank 0 reads; nobody else needs to see the file. Collective.
/// \throws InputError, the same on all ranks, if the file is missing, no checkpoint, cut off, too long,
/// damaged, or holds a number that is not finite.
Checkpoint readCheckpoint(const std::filesystem::path& file, const Comm& comm);

/// λ on the problem's multiplierMap. Collective.
/// \param fingerprint  of the problem
/// \throws InputError if the checkpoint belongs to another problem, saying in what they differ.
RCP<Vector> multipliersOf(const Checkpoint& checkpoint, const decomposition::DecomposedProblem& problem,
                          const Fingerprint& fingerprint);

} // namespace epafi::output
