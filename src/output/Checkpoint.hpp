#pragma once

/// Multipliers in a file, for a run to go on from.
///
/// The file is a text (CheckpointHeader.hpp), λ in the order of its rows, 8 bytes a number, and a checksum of all that. It does
/// not depend on the number of ranks. That it is no HDF5 has a reason: damaged files must end with a sentence, and what HDF5
/// does with them is not in our hands.

#include "epafi/output/Fingerprint.hpp"

#include <filesystem>
#include <vector>

namespace epafi::output {

struct Checkpoint {
  std::filesystem::path file;
  Fingerprint fingerprint;   ///< of the problem that λ belongs to
  std::vector<double> share; ///< this rank's even share of λ (evenShare in Slab.hpp), finite
};

/// Writes λ; the file appears complete or not at all, and is on the disk then, not only on its way there. Creates its
/// directory. Rank 0 writes, the others send it their shares one after the other.
/// \param lambda  on the problem's multiplierMap
/// Collective. \throws InputError if the directory cannot be made or written to, Error if writing fails; an older file is
/// untouched then.
void writeCheckpoint(const std::filesystem::path& file, const Fingerprint& fingerprint, const Vector& lambda);

/// Rank 0 reads; nobody else needs to see the file. Collective.
/// \throws InputError, the same on all ranks, if the file is missing, no checkpoint, cut off, too long, damaged, or
/// holds a number that is not finite.
Checkpoint readCheckpoint(const std::filesystem::path& file, const Comm& comm);

/// λ on the problem's multiplierMap. Collective.
/// \param fingerprint  of the problem
/// \throws InputError if the checkpoint belongs to another problem, saying in what they differ.
RCP<Vector> multipliersOf(const Checkpoint& checkpoint, const decomposition::DecomposedProblem& problem,
                          const Fingerprint& fingerprint);

} // namespace epafi::output
