#include "Options.hpp"

#include "epafi/base/Errors.hpp"

#include <charconv>
#include <cmath>

namespace epafi::drivers {

namespace {

double secondsOf(const std::string& text) {
  double seconds = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size() || !(seconds >= 0) || !std::isfinite(seconds))
    throw InputError("option --checkpoint-interval is '" + text +
                     "', but must be a number of seconds, 0 or more; see epafi --help");
  return seconds;
}

} // namespace

Options parseOptions(int argc, const char* const* argv) {
  Options options;
  const std::vector<std::string> known{
      "--set",   "--output", "--report", "--restart", "--checkpoint-interval", "--print-parameters",
      "--quiet", "--help",   "--version"};
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    std::string attached;
    const bool hasAttached = word.rfind("--", 0) == 0 && word.find('=') != std::string::npos;
    if (hasAttached) {
      attached = word.substr(word.find('=') + 1);
      word.erase(word.find('='));
    }
    bool takesValue = false;
    const auto value = [&] {
      takesValue = true;
      std::string text = hasAttached ? attached : i + 1 < argc ? argv[++i] : "";
      if (text.empty())
        throw InputError("option " + word + " needs a value; see epafi --help");
      return text;
    };
    if (word == "--set") {
      options.overrides.push_back(value());
    } else if (word == "--output") {
      options.output = value();
    } else if (word == "--report") {
      options.report = value();
    } else if (word == "--restart") {
      options.restart = value();
    } else if (word == "--checkpoint-interval") {
      options.checkpointInterval = secondsOf(value());
    } else if (word == "--print-parameters") {
      options.printParameters = true;
    } else if (word == "--quiet" || word == "-q") {
      options.quiet = true;
    } else if (word == "--help" || word == "-h") {
      options.help = true;
    } else if (word == "--version") {
      options.version = true;
    } else if (word.size() > 1 && word.front() == '-') {
      const std::string near = nearestName(word, known);
      throw InputError("unknown option " + word + (near.empty() ? "" : "; did you mean " + near + "?") +
                       " (see epafi --help)");
    } else if (!options.scene.empty()) {
      throw InputError("two scenes are given, '" + options.scene + "' and '" + word +
                       "'; epafi solves one at a time");
    } else {
      options.scene = word;
    }
    if (hasAttached && !takesValue)
      throw InputError("option " + word + " takes no value; see epafi --help");
  }
  if (options.scene.empty() && !options.printParameters && !options.help && !options.version)
    throw InputError("no scene is given; call epafi SCENE.xml (see epafi --help)");
  return options;
}

std::string usage() {
  return "Usage: epafi SCENE.xml [OPTION]...\n"
         "Solves the contact problem of an XML scene by FETI-DP; start it with mpirun for several ranks.\n\n"
         "  --set \"List/Sub list/Parameter=value\"  change one parameter of the scene (repeat for more)\n"
         "  --output DIR                           write DIR/<scene>.h5, .xdmf, history.csv, report.xml and\n"
         "                                         checkpoint.epafi\n"
         "  --report FILE.xml                      write the report as an XML parameter list\n"
         "  --restart CHECKPOINT                   go on from a checkpoint of this scene, on any number of "
         "ranks\n"
         "  --checkpoint-interval SECONDS          time between checkpoints (600); 0: only at the end\n"
         "  --print-parameters                     print all parameters with defaults, ranges and meaning\n"
         "  --quiet                                print errors only\n"
         "  --version                              print the version\n"
         "  --help                                 print this text\n\n"
         "SIGINT, SIGTERM, SIGHUP or SIGUSR1 ends the iteration, and what was asked for is written.\n"
         "Exit codes: 0 solved to the asked tolerance; 1 stopped without reaching it, a file could not be\n"
         "written, or a rank failed; 2 wrong input; 3 the problem has no solution, or more than one.\n";
}

} // namespace epafi::drivers
