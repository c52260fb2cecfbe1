/// `epafi-study STUDY`: measurements as tables and pictures.

#include "CommandLine.hpp"
#include "JointEnd.hpp"
#include "Places.hpp"
#include "Studies.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>

namespace {

using namespace epafi;
using namespace epafi::drivers;

constexpr const char* usage =
    "Usage: epafi-study STUDY [--output DIR] [--quick]\n"
    "Writes DIR/<study>.csv, a table to read and a picture (DIR is . by default); --quick ends within a "
    "minute.\n\n"
    "  accuracy  what each digit takes: errors over time and products by mesh, tolerance and method; rows "
    "of\n"
    "            DIR/peers.csv and DIR/peers/*/peers.csv, as drivers/compare/peers writes them, join in\n"
    "  targets   scenes that are asked for an accuracy: the true error beside target and estimate\n"
    "  refinement  seconds of local refinement to a target beside those of even meshes, over the true error\n"
    "  tables    Tables 1 and 2 of the paper: dimensions and iterations, ours beside the paper's\n"
    "  qp        problems with bounds: products with the Hessian by method, preconditioner and start\n"
    "  scaling   time, memory and messages over the number of subdomains, their size and the number of "
    "ranks;\n"
    "            rows of other numbers of ranks that DIR/scaling.csv holds are kept\n"
    "  stability  hard cases, the outcome beside the expected one; on one rank each, but those of the "
    "family\n"
    "            'ranks', which take up to 7: mpirun --oversubscribe -n 7 has them all\n"
    "  heterogeneity  products and condition numbers where the stiffness jumps, without and with adaptive\n"
    "            constraints\n"
    "  spectra   extreme eigenvalues of F, plain and preconditioned, of its gluing and contact parts, over\n"
    "            H/h and 1/H: FETI-DP, FETI and hybrid\n";

using Study = bool (*)(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);
const std::map<std::string, Study> studies{
    {"accuracy", studyAccuracy}, {"tables", studyTables},         {"qp", studyQp},
    {"scaling", studyScaling},   {"stability", studyStability},   {"heterogeneity", studyHeterogeneity},
    {"targets", studyTargets},   {"refinement", studyRefinement}, {"spectra", studySpectra}};

struct Request {
  std::string study;
  std::filesystem::path directory = ".";
  bool quick = false, help = false;
};

Request parse(int argc, char** argv) {
  Request request;
  CommandLine line("epafi-study");
  line.flag("--quick", request.quick)
      .value("--output", [&](const std::string& text) { request.directory = text; })
      .words([&](const std::string& word) {
        if (!request.study.empty())
          throw InputError("two studies are given, '" + request.study + "' and '" + word +
                           "'; run them one at a time");
        request.study = word;
      });
  request.help = line.parse(argc, argv);
  if (!request.help && studies.count(request.study) == 0) {
    std::string names;
    for (const auto& [name, study] : studies)
      names += (names.empty() ? "" : ", ") + name;
    throw InputError((request.study.empty() ? "no study is named" : "unknown study '" + request.study + "'") +
                     "; the studies are: " + names);
  }
  return request;
}

/// Draws the CSV with the plotting program that stands beside this one. Called after MPI has ended.
bool draw(const std::filesystem::path& csv) {
  const auto plot = programDirectory() / "epafi-plot";
  std::cout << std::flush; // the table first
  const std::string command =
      "'" + plot.string() + "' '" + csv.string() + "' --output '" + csv.parent_path().string() + "'";
  return std::system(command.c_str()) == 0; // NOLINT(bugprone-command-processor): the path is quoted
}

} // namespace

int main(int argc, char** argv) {
  Request request;
  bool drawsPicture = false;
  const int exitCode = runMain(argc, argv, "epafi-study", [&](const RCP<const Comm>& comm) {
    request = parse(argc, argv);
    if (request.help) {
      if (comm->getRank() == 0)
        std::cout << usage << "\nThe scenes are those in " << sceneDirectory().string() << ".\n";
      return 0;
    }
    collectively(*comm, [&] {
      std::error_code error;
      std::filesystem::create_directories(request.directory, error);
      if (error)
        throw InputError("the directory " + request.directory.string() +
                         " cannot be made: " + error.message());
    });
    const bool isRight = studies.at(request.study)(request.directory, request.quick, comm);
    drawsPicture = comm->getRank() == 0;
    return isRight ? 0 : 1;
  });
  if (drawsPicture && !draw(std::filesystem::absolute(request.directory) / (request.study + ".csv"))) {
    std::cerr << "epafi-study: the picture was not drawn (see above); the table is complete\n";
    return 1;
  }
  return exitCode;
}
