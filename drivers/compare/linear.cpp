/// `epafi-linear cholmod|muelu`: one linear solve of the model problem's membranes with a contact zone that
/// is given, for `compare/peers`. Prints its measurements as one line of JSON.

#include "ClosedMembranes.hpp"
#include "CommandLine.hpp"
#include "JointEnd.hpp"
#include "LinearSolve.hpp"
#include "epafi/base/PeakMemory.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Time.hpp>

#include <cmath>
#include <iostream>
#include <sstream>
#include <string>

namespace {

using namespace epafi;
using namespace epafi::drivers;

constexpr const char* usage =
    "Usage: epafi-linear cholmod|muelu --size N --closed M [--problem coercive|semicoercive]\n"
    "Solves the membranes of the model problem, 1/h = N, with the M lowest nodes of the contact line closed, "
    "by one\n"
    "linear solve on one rank; prints times in seconds, iterations, energy and peak memory as one line of "
    "JSON.\n";

/// Relative residual that the iteration is asked for.
constexpr double tolerance = 1e-8;

struct Request {
  std::string solver;
  MembraneChoice membranes;
  bool help = false;
};

bool isCoercive(const std::string& problem) {
  if (problem != "coercive" && problem != "semicoercive")
    throw InputError("option --problem is '" + problem + "'; allowed are coercive and semicoercive");
  return problem == "coercive";
}

Request parse(int argc, char** argv) {
  Request request;
  std::string closed = "0";
  int& elements = request.membranes.elements;
  CommandLine line("epafi-linear");
  line.integer("--size", elements, 4, 8192)
      .value("--closed", closed)
      .value("--problem",
             [&](const std::string& problem) { request.membranes.coercive = isCoercive(problem); })
      .words([&](const std::string& word) {
        if (!request.solver.empty() || (word != "cholmod" && word != "muelu"))
          throw InputError("'" + word + "' is not understood; see epafi-linear --help");
        request.solver = word;
      });
  request.help = line.parse(argc, argv);
  if (request.help)
    return request;
  if (request.solver.empty())
    throw InputError("no solver is named; it is cholmod or muelu");
  if (elements == 0 || elements % 4 != 0)
    throw InputError("option --size must be given, as a multiple of 4: the loads end at quarters of a side");
  request.membranes.closedNodes = integerOption("--closed", closed, 1, elements + 1);
  return request;
}

std::string measure(const Request& request) {
  const double start = Teuchos::Time::wallTime();
  const LinearSystem system = closedMembranes(request.membranes);
  const double assembled = Teuchos::Time::wallTime();
  resetPeakBytes(); // the solver's counts, and what it is given
  const LinearSolution solution =
      request.solver == "cholmod" ? solveByCholmod(system) : solveByMueLu(system, tolerance);
  const double peak = peakBytes();
  const Eigen::VectorXd product = system.matrix * solution.u;
  const double residual = (system.load - product).norm() / system.load.norm();
  if (!(residual <= 2 * tolerance))
    throw Error("the relative residual is " + std::to_string(residual) + ", but 1e-8 was asked for");
  std::ostringstream line;
  line.precision(16);
  line << R"({"unknowns": )" << system.load.size() << R"(, "assembly_seconds": )" << assembled - start
       << R"(, "setup_seconds": )" << solution.setupSeconds << R"(, "solve_seconds": )"
       << solution.solveSeconds << R"(, "iterations": )" << solution.iterations << R"(, "energy": )"
       << 0.5 * solution.u.dot(product) - system.load.dot(solution.u) << R"(, "relative_residual": )"
       << residual << R"(, "peak_bytes": )" << std::llround(peak) << "}\n";
  return line.str();
}

} // namespace

int main(int argc, char** argv) {
  return runMain(argc, argv, "epafi-linear", [&](const RCP<const Comm>&) {
    const Request request = parse(argc, argv);
    std::cout << (request.help ? usage : measure(request));
    return 0;
  });
}
