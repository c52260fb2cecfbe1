// What the changes of a problem cost: loads, gaps, contact rows and matrices, each beside setting all up
// anew. Prints the seconds of setup or update, and those of the solve that follows.
#include "Block.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/model/Decompose.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cstdio>
#include <memory>
#include <string>

using epafi::decomposition::DecomposedProblem;
using epafi::decomposition::RowKind;
using epafi::decomposition::SparseMatrix;

/// Solves and prints a line; `seconds` are those of setup or update.
bool solveAndTell(epafi::ContactSolver& solver, const epafi::decomposition::ProblemData& data,
                  const epafi::Comm& comm, const std::string& change, double seconds) {
  const epafi::fetidp::ContactSolution solution = solver.solve(data);
  if (comm.getRank() == 0)
    std::printf("%-28s %8.4f s, then %8.4f s and %d products\n", change.c_str(), seconds,
                solver.times().solve + solver.times().recovery,
                solver.report().counts.hessianMultiplications);
  return solver.report().status == epafi::qp::Status::converged;
}

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const int elements = argc > 1 ? std::stoi(argv[1]) : 8;
  epafi::model::Decomposition cut = epafi::model::decompose(block(elements, elements), comm);
  DecomposedProblem& problem = cut.problem;
  const auto press = [&](double by) { // the floor on top comes down everywhere
    const auto gaps = cut.data.contactGaps(problem);
    gaps->putScalar(-by);
    cut.data.setGaps(*gaps);
  };
  press(0.01);
  epafi::ContactSolver solver{Teuchos::ParameterList("Solver")};
  solver.setup(problem, cut.data);
  bool isSolved = solveAndTell(solver, cut.data, *comm, "everything", solver.times().setup);

  press(0.02);
  cut.data.scaleLoads(2);
  isSolved = solveAndTell(solver, cut.data, *comm, "loads and gaps", 0) && isSolved;

  for (auto& subdomain : problem.subdomains) // the same rows in another unit: their unknowns stay
    for (auto& entry : subdomain.constraint)
      if (problem.kindOf(entry.multiplier) == RowKind::contact)
        entry.coefficient *= 2;
  press(0.04);
  solver.update(cut.data);
  isSolved = solveAndTell(solver, cut.data, *comm, "contact rows", solver.times().setup) && isSolved;

  for (auto& subdomain : problem.subdomains)
    subdomain.stiffness = std::make_shared<SparseMatrix>(1.5 * *subdomain.stiffness);
  solver.update(cut.data);
  isSolved =
      solveAndTell(solver, cut.data, *comm, "matrices, pattern kept", solver.times().setup) && isSolved;

  if (!problem.subdomains.empty())
    problem.subdomains.front().stiffness =
        std::make_shared<SparseMatrix>(1.5 * *problem.subdomains.front().stiffness);
  solver.update(cut.data);
  isSolved = solveAndTell(solver, cut.data, *comm, "one matrix a rank", solver.times().setup) && isSolved;
  return isSolved ? 0 : 1;
}
