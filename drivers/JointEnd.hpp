#pragma once

/// The end of a program on all ranks alike, whichever of them failed.

#include "epafi/base/Types.hpp"

#include <functional>
#include <string>

namespace epafi::drivers {

/// notConverged stands for whatever else was not done as well: a file that could not be written, a rank that
/// failed.
enum ExitCode : int { solved = 0, notConverged = 1, wrongInput = 2, notSolvable = 3 };

/// Runs `work` on every rank. Returns the exit code: what `work` returns, or the code of the error that it
/// throws, of which one rank tells on the error stream.
///
/// Most errors are thrown by all ranks together (epafi/base/Collective.hpp): rank 0 says which, and all
/// return. What one rank throws alone, out of memory say, leaves the others waiting for it in some message.
/// So whoever throws waits for all others to do so too, `patience` seconds at most; then the lowest of those
/// that threw speaks, with its rank, and MPI_Abort ends the others with the code. Nothing hangs as long as
/// what was thrown gets here: destructors must not wait for other ranks. Collective; from here on messages of
/// its own.
/// \param program  whose name begins what is told
int endTogether(const Comm& comm, const std::function<int()>& work, double patience = 3.0,
                const std::string& program = "epafi");

/// A process that nobody launched beside others needs no daemon of Open MPI, no search for fast networks and
/// no X server, which take ten times as long as the rest of the start; nor a directory for what ranks share,
/// which would be that of all such processes: one that starts while another one ends fails when that takes it
/// away. What the user has set stays.
void startLean();

/// What the programs' main() does: MPI from here to the end, and `work` on all ranks, with memory as
/// keepFreedMemory has it. Returns the exit code.
int runMain(int argc, char** argv, const std::string& program,
            const std::function<int(const RCP<const Comm>&)>& work);

} // namespace epafi::drivers
