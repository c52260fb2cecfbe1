/// `epafi-poisson LIST.xml|cholmod`: −Δu = 1 on the unit square by whatever linear solver a list for Stratimikos asks for, for
/// `compare/poisson`. Rank 0 prints the measurements as one line of JSON.

#include "IntegerOption.hpp"
#include "LinearSolve.hpp"
#include "PeerStrategies.hpp"
#include "PoissonProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/ThyraOperators.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <sys/resource.h>

#include <iostream>
#include <sstream>
#include <string>

namespace {

using namespace epafi;
using namespace epafi::drivers;

constexpr const char* usage =
    "Usage: epafi-poisson LIST.xml|cholmod --size N [--subdomains M] [--separate]\n"
    "Solves -div grad u = 1 on the unit square, u = 0 on its sides, with N x N Q1 elements, by the solver "
    "that "
    "the list\n"
    "names, Stratimikos's own, \"Epafi FETI-DP\" or a preconditioner \"Epafi BDDC\", \"MueLu\" or "
    "\"FROSch\", or, "
    "on one rank,\n"
    "by CHOLMOD; with M x M subdomains (default: N/16). --separate: identical subdomains share nothing. "
    "Prints "
    "times in\n"
    "seconds, iterations, relative residual, error and peak memory of all ranks as one line of JSON.\n";

struct Request {
  std::string solver;
  int elements = 0, subdomains = 0;
  bool isSeparate = false, help = false;
};

Request parse(int argc, char** argv) {
  Request request;
  std::string subdomains;
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
      request.elements = integerOption(word, value(), 2, 8192);
    else if (word == "--subdomains")
      subdomains = value();
    else if (word == "--separate")
      request.isSeparate = true;
    else if (request.solver.empty() && word.front() != '-')
      request.solver = word;
    else
      throw InputError("'" + word + "' is not understood; see epafi-poisson --help");
  }
  if (request.help)
    return request;
  if (request.solver.empty())
    throw InputError("no solver is named; name a list for Stratimikos, or cholmod");
  if (request.elements == 0)
    throw InputError("option --size must be given");
  request.subdomains = subdomains.empty() ? std::max(1, request.elements / 16)
                                          : integerOption("--subdomains", subdomains, 1, request.elements);
  return request;
}

struct Measurements {
  RCP<Vector> u;
  double setupSeconds = 0, solveSeconds = 0;
  int iterations = 0;
};

long long peakBytes(const Comm& comm) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return sumOverRanks(comm, static_cast<GlobalOrdinal>(1024) * used.ru_maxrss);
}

double since(const Comm& comm, double start) {
  return maxOverRanks(comm, Teuchos::Time::wallTime() - start);
}

/// The rows of a matrix that lies on one rank.
SparseSystem systemOf(const CrsMatrix& k, const Vector& load) {
  SparseSystem system;
  system.rowStarts = {0};
  CrsMatrix::local_inds_host_view_type columns;
  CrsMatrix::values_host_view_type values;
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(*k.getRowMap())); ++row) {
    k.getLocalRowView(row, columns, values);
    system.columns.insert(system.columns.end(), columns.data(), columns.data() + columns.extent(0));
    system.values.insert(system.values.end(), values.data(), values.data() + values.extent(0));
    system.rowStarts.push_back(static_cast<int>(system.columns.size()));
  }
  const auto entries = load.getData();
  system.load.assign(entries.begin(), entries.end());
  return system;
}

Measurements byCholmod(const CrsMatrix& k, const Vector& load) {
  if (load.getMap()->getComm()->getSize() > 1)
    throw InputError("cholmod runs on one rank, but there are " +
                     std::to_string(load.getMap()->getComm()->getSize()));
  const LinearSolution solution = solveByCholmod(systemOf(k, load));
  const auto values = Teuchos::arrayViewFromVector(solution.u);
  return {rcp(new Vector(k.getDomainMap(), values)), solution.setupSeconds, solution.solveSeconds, 1};
}

/// \param k  as the solver takes it
Measurements byStratimikos(const adapters::LinearSolveStrategy& strategy, const RCP<const Operator>& k,
                           const RCP<const Vector>& load) {
  const Comm& comm = *load->getMap()->getComm();
  const auto forward = fetidp::asThyra(k);
  Measurements result;
  result.u = rcp(new Vector(k->getDomainMap()));
  const double start = Teuchos::Time::wallTime();
  const auto op = Thyra::linearOpWithSolve<double>(strategy, forward);
  result.setupSeconds = since(comm, start);
  const double prepared = Teuchos::Time::wallTime();
  const auto status = op->solve(Thyra::NOTRANS, *Thyra::createConstVector<double>(load, forward->range()),
                                Thyra::createVector<double>(result.u, forward->domain()).ptr());
  result.solveSeconds = since(comm, prepared);
  if (status.solveStatus != Thyra::SOLVE_STATUS_CONVERGED)
    throw Error("the solver did not reach its tolerance: " + status.message);
  result.iterations =
      status.extraParameters.is_null() ? 1 : status.extraParameters->get("Iteration Count", 1);
  return result;
}

/// The list, in which Epafi's solvers share nothing if they are not to.
RCP<Teuchos::ParameterList> listOf(const Request& request) {
  const auto list = Teuchos::getParametersFromXmlFile(request.solver);
  if (request.isSeparate)
    for (const auto& [kind, name] :
         {std::pair("Linear Solver Types", "Epafi FETI-DP"), std::pair("Preconditioner Types", "Epafi BDDC")})
      list->sublist(kind).sublist(name).sublist("Direct Solvers").set("Share Identical Subdomains", "no");
  return list;
}

double relativeResidual(const Operator& k, const Vector& u, const Vector& load) {
  Vector residual(load, Teuchos::Copy);
  k.apply(u, residual, Teuchos::NO_TRANS, -1.0, 1.0);
  return residual.norm2() / load.norm2();
}

std::string measure(const Request& request, const RCP<const Comm>& comm) {
  const bool isDirect = request.solver == "cholmod";
  const auto list = isDirect ? Teuchos::null : listOf(request);
  const double start = Teuchos::Time::wallTime();
  const PoissonProblem problem(request.elements, request.subdomains, comm);
  const RCP<const Vector> load = problem.k->load();
  RCP<const Operator> k = problem.k;
  if (isDirect || list->get<std::string>("Linear Solver Type") != "Epafi FETI-DP")
    k = assembled(*problem.k);
  const double assemblySeconds = since(*comm, start);
  const Measurements found = isDirect ? byCholmod(dynamic_cast<const CrsMatrix&>(*k), *load)
                                      : byStratimikos(*strategyAmongPeers(list, problem.k), k, load);
  const long long peak = peakBytes(*comm);
  std::ostringstream line;
  line.precision(16);
  line << R"({"unknowns": )" << load->getGlobalLength() << R"(, "ranks": )" << comm->getSize()
       << R"(, "subdomains": )" << problem.k->problem().numSubdomains << R"(, "assembly_seconds": )"
       << assemblySeconds << R"(, "setup_seconds": )" << found.setupSeconds << R"(, "solve_seconds": )"
       << found.solveSeconds << R"(, "iterations": )" << found.iterations << R"(, "relative_residual": )"
       << relativeResidual(*problem.k, *found.u, *load) << R"(, "error": )"
       << relativeError(*found.u, solutionBySines(request.elements)) << R"(, "peak_bytes": )" << peak
       << "}\n";
  return line.str();
}

} // namespace

int main(int argc, char** argv) {
  int programNameOnly = 1; // Kokkos would answer --help itself
  const Tpetra::ScopeGuard scope(&programNameOnly, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const auto complain = [&](const std::exception& error) {
    if (comm->getRank() == 0)
      std::cerr << "epafi-poisson: " << sentenceOf(error, 0) << '\n';
  };
  try {
    const Request request = parse(argc, argv);
    const std::string text = request.help ? usage : measure(request, comm);
    if (comm->getRank() == 0)
      std::cout << text;
    return 0;
  } catch (const InputError& error) {
    complain(error);
    return 2;
  } catch (const std::exception& error) {
    complain(error);
    return 1;
  }
}
