#include "Options.hpp"

#include "CommandLine.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/deck/DeckModel.hpp"
#include "epafi/meshing/MeshSource.hpp"

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
  CommandLine line("epafi");
  line.value("--set", [&](const std::string& text) { options.overrides.push_back(text); })
      .value("--accuracy",
             [&](const std::string& text) {
               if (text == "0" || text == "0%" || text == "0 %")
                 throw InputError("option --accuracy is '" + text +
                                  "', but no mesh is without error; ask for 1% say");
               options.overrides.push_back("Accuracy/Target=" + text);
             })
      .value("--output", options.output)
      .value("--report", options.report)
      .value("--frd", options.frd)
      .value("--dat", options.dat)
      .value("--export", options.exported)
      .value("--show", options.show)
      .value("--restart", options.restart)
      .value("--checkpoint-interval",
             [&](const std::string& text) { options.checkpointInterval = secondsOf(text); })
      .flag("--print-parameters", options.printParameters)
      .flag("--list", options.list)
      .flag("--print-pairs", options.printPairs)
      .flag("--quiet", options.quiet)
      .flag("--version", options.version)
      .words([&](const std::string& word) {
        if (meshing::isStep(options.scene) && options.completion.empty()) {
          options.completion = word;
          return;
        }
        if (!options.scene.empty())
          throw InputError("two scenes are given, '" + options.scene + "' and '" + word +
                           "'; epafi solves one at a time");
        options.scene = word;
      });
  options.help = line.parse(argc, argv);
  if (!options.dat.empty() && !deck::isDeck(options.scene))
    throw InputError("option --dat is for input decks, but '" + options.scene + "' is none (.inp)");
  if (options.scene.empty() && !options.printParameters && !options.help && !options.version)
    throw InputError("no scene is given; call epafi SCENE.xml (see epafi --help)");
  return options;
}

std::string usage() {
  return "Usage: epafi SCENE.xml [OPTION]...\n"
         "       epafi DECK.inp [OPTION]...\n"
         "       epafi ASSEMBLY.step [SCENE.xml] [OPTION]...\n"
         "Solves the contact problem of an XML scene, of an input deck as CalculiX and Abaqus have them, or "
         "of an\n"
         "assembly of CAD that a few lines of XML complete, by FETI-DP; start it with mpirun for several "
         "ranks.\n\n"
         "  --set \"List/Sub list/Parameter=value\"  change one parameter of the scene (repeat for more)\n"
         "  --accuracy SHARE                       refine until the estimated error is at most 1% say\n"
         "  --output DIR                           write DIR/<scene>.h5, .xdmf, history.csv, report.xml and\n"
         "                                         checkpoint.epafi\n"
         "  --report FILE.xml                      write the report as an XML parameter list\n"
         "  --frd FILE.frd                         write displacements, stresses and contact of elastic "
         "bodies as\n"
         "                                         CalculiX does, for FreeCAD, PrePoMax and cgx\n"
         "  --dat FILE.dat                         write what a deck asks to be printed, as CalculiX does\n"
         "  --export SCENE.xml                     write a deck as a scene with its mesh beside it, "
         "SCENE.msh, or\n"
         "                                         an assembly as a whole scene, and solve nothing\n"
         "  --list                                 print bodies, faces in words and pairs that are found\n"
         "  --show FILE.svg                        draw bodies and faces with the numbers that --list has\n"
         "  --print-pairs                          print the pairs that are found as XML to paste\n"
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
