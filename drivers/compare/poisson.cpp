/// `epafi-poisson LIST.xml|cholmod`: −Δu = 1 on the unit square by whatever linear solver a list for
/// Stratimikos asks for, for `compare/poisson`. Rank 0 prints the measurements as one line of JSON.

#include "CommandLine.hpp"
#include "JointEnd.hpp"
#include "LinearSolve.hpp"
#include "PeerStrategies.hpp"
#include "PoissonProblem.hpp"
#include "epafi/base/PeakMemory.hpp"

#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
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
  CommandLine line("epafi-poisson");
  line.integer("--size", request.elements, 2, 8192)
      .value("--subdomains", subdomains)
      .flag("--separate", request.isSeparate)
      .words([&](const std::string& word) {
        if (!request.solver.empty())
          throw InputError("'" + word + "' is not understood; see epafi-poisson --help");
        request.solver = word;
      });
  request.help = line.parse(argc, argv);
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

double since(const Comm& comm, double start) {
  return maxOverRanks(comm, Teuchos::Time::wallTime() - start);
}

/// Of a matrix that lies on one rank.
LinearSystem systemOf(const CrsMatrix& k, const Vector& load) {
  std::vector<Eigen::Triplet<double>> entries;
  CrsMatrix::local_inds_host_view_type columns;
  CrsMatrix::values_host_view_type values;
  const auto n = static_cast<LocalOrdinal>(numLocal(*k.getRowMap()));
  for (LocalOrdinal row = 0; row < n; ++row) {
    k.getLocalRowView(row, columns, values);
    for (std::size_t i = 0; i < columns.extent(0); ++i)
      entries.emplace_back(row, columns[i], values[i]);
  }
  LinearSystem system;
  system.matrix.resize(n, n);
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  system.load = Eigen::Map<const Eigen::VectorXd>(load.getData().getRawPtr(), n);
  return system;
}

Measurements byCholmod(const CrsMatrix& k, const Vector& load) {
  if (load.getMap()->getComm()->getSize() > 1)
    throw InputError("cholmod runs on one rank, but there are " +
                     std::to_string(load.getMap()->getComm()->getSize()));
  const LinearSolution solution = solveByCholmod(systemOf(k, load));
  const auto values = Teuchos::arrayView(solution.u.data(), solution.u.size());
  return {rcp(new Vector(k.getDomainMap(), values)), solution.setupSeconds, solution.solveSeconds, 1};
}

/// \param k  as the solver takes it
Measurements byStratimikos(const adapters::LinearSolveStrategy& strategy, const RCP<const Operator>& k,
                           const RCP<const Vector>& load) {
  const Comm& comm = *load->getMap()->getComm();
  const auto forward = adapters::asThyra(k);
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
  const RCP<const Vector> load = problem.k->load(problem.decomposition->data);
  RCP<const Operator> k = problem.k;
  if (isDirect || list->get<std::string>("Linear Solver Type") != "Epafi FETI-DP")
    k = assembled(*problem.k);
  const double assemblySeconds = since(*comm, start);
  const Measurements found = isDirect ? byCholmod(dynamic_cast<const CrsMatrix&>(*k), *load)
                                      : byStratimikos(*strategyAmongPeers(list, problem.k), k, load);
  const double peak = sumOverRanks(*comm, peakBytes());
  std::ostringstream line;
  line.precision(16);
  line << R"({"unknowns": )" << load->getGlobalLength() << R"(, "ranks": )" << comm->getSize()
       << R"(, "subdomains": )" << problem.k->problem().numSubdomains << R"(, "assembly_seconds": )"
       << assemblySeconds << R"(, "setup_seconds": )" << found.setupSeconds << R"(, "solve_seconds": )"
       << found.solveSeconds << R"(, "iterations": )" << found.iterations << R"(, "relative_residual": )"
       << relativeResidual(*problem.k, *found.u, *load) << R"(, "error": )"
       << relativeError(*found.u, solutionBySines(request.elements)) << R"(, "peak_bytes": )"
       << std::llround(peak) << "}\n";
  return line.str();
}

} // namespace

int main(int argc, char** argv) {
  return runMain(argc, argv, "epafi-poisson", [&](const RCP<const Comm>& comm) {
    const Request request = parse(argc, argv);
    const std::string text = request.help ? usage : measure(request, comm);
    if (comm->getRank() == 0)
      std::cout << text;
    return 0;
  });
}
