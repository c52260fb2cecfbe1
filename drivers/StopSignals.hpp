#pragma once

/// Signals that ask a run to stop.

#include <string>

namespace epafi::drivers {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGUSR1 are remembered instead of ending this rank; a second one,
/// more than 0.2 s after the first, ends it at once. Signals that were ignored before (by nohup, say) stay
/// so. Writing to a pipe that nobody reads, or beyond the limit of a file's size, becomes an error of the
/// writer instead of the end of the program. Not collective.
void listenToStopSignals();

/// The signal that came first to this rank, "SIGTERM"; empty if none did. Not collective.
std::string stopSignal();

} // namespace epafi::drivers
