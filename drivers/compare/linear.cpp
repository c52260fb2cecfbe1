/// `epafi-linear cholmod|muelu`: one linear solve of the model problem's membranes with a contact zone that is given,
/// for `compare/peers`. Prints its measurements as one line of JSON.

#include "ClosedMembranes.hpp"
#include "IntegerOption.hpp"
#include "LinearSolve.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_Core.hpp>
#include <sys/resource.h>

#include <cmath>
#include <iostream>
#include <numeric>
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
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&]() -> std::string {
      if (++i >= argc)
        throw InputError("option " + word + " needs a value");
      return argv[i];
    };
    if (word == "--help" || word == "-h")
      request.help = true;
    else if (word == "--size")
      request.membranes.elements = integerOption(word, value(), 4, 8192);
    else if (word == "--closed")
      closed = value();
    else if (word == "--problem")
      request.membranes.coercive = isCoercive(value());
    else if (request.solver.empty() && (word == "cholmod" || word == "muelu"))
      request.solver = word;
    else
      throw InputError("'" + word + "' is not understood; see epafi-linear --help");
  }
  if (request.help)
    return request;
  if (request.solver.empty())
    throw InputError("no solver is named; it is cholmod or muelu");
  if (request.membranes.elements == 0 || request.membranes.elements % 4 != 0)
    throw InputError("option --size must be given, as a multiple of 4: the loads end at quarters of a side");
  request.membranes.closedNodes = integerOption("--closed", closed, 1, request.membranes.elements + 1);
  return request;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double relativeResidual(const SparseSystem& system, const std::vector<double>& product) {
  double sum = 0;
  for (std::size_t i = 0; i < product.size(); ++i)
    sum += (system.load[i] - product[i]) * (system.load[i] - product[i]);
  return std::sqrt(sum / dot(system.load, system.load));
}

long long peakBytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return 1024LL * used.ru_maxrss;
}

std::string measure(const Request& request) {
  const double start = Teuchos::Time::wallTime();
  const SparseSystem system = closedMembranes(request.membranes);
  const double assembled = Teuchos::Time::wallTime();
  const LinearSolution solution =
      request.solver == "cholmod" ? solveByCholmod(system) : solveByMueLu(system, tolerance);
  const long long peak = peakBytes();
  const std::vector<double> product = system.product(solution.u);
  const double residual = relativeResidual(system, product);
  if (!(residual <= 2 * tolerance))
    throw Error("the relative residual is " + std::to_string(residual) + ", but 1e-8 was asked for");
  std::ostringstream line;
  line.precision(16);
  line << R"({"unknowns": )" << system.size() << R"(, "assembly_seconds": )" << assembled - start
       << R"(, "setup_seconds": )" << solution.setupSeconds << R"(, "solve_seconds": )"
       << solution.solveSeconds << R"(, "iterations": )" << solution.iterations << R"(, "energy": )"
       << 0.5 * dot(solution.u, product) - dot(system.load, solution.u) << R"(, "relative_residual": )"
       << residual << R"(, "peak_bytes": )" << peak << "}\n";
  return line.str();
}

} // namespace

int main(int argc, char** argv) {
  int programNameOnly = 1; // Kokkos would answer --help itself
  const Tpetra::ScopeGuard scope(&programNameOnly, &argv);
  try {
    const Request request = parse(argc, argv);
    std::cout << (request.help ? usage : measure(request));
    return 0;
  } catch (const InputError& error) {
    std::cerr << "epafi-linear: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "epafi-linear: " << error.what() << '\n';
    return 1;
  }
}
