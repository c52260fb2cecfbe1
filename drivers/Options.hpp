#pragma once

/// The command line of `epafi`.

#include <string>
#include <vector>

namespace epafi::drivers {

struct Options {
  std::string scene;                  ///< XML file, input deck or STEP file
  std::string completion;             ///< XML file that completes a STEP file; empty: none
  std::vector<std::string> overrides; ///< --set
  std::string output;                 ///< --output DIR; empty: no files
  std::string report;                 ///< --report FILE; empty: only DIR/report.xml
  std::string exported;               ///< --export FILE; empty: none, the scene is solved
  std::string show;                   ///< --show FILE; empty: none, the scene is solved
  std::string frd;                    ///< --frd FILE; empty: none
  std::string dat;                    ///< --dat FILE; empty: none
  std::string restart;                ///< --restart FILE, a checkpoint; empty: from the beginning
  double checkpointInterval = 600;    ///< --checkpoint-interval, seconds; 0: only at the end
  bool printParameters = false, list = false, printPairs = false, quiet = false, help = false,
       version = false;
};

/// \throws InputError for an unknown option or a missing value. Not collective (all ranks see the same
/// arguments).
Options parseOptions(int argc, const char* const* argv);

/// What --help prints.
std::string usage();

} // namespace epafi::drivers
