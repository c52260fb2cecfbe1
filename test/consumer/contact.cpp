#include "epafi/ContactSolver.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Tpetra_Core.hpp>

#include <iomanip>
#include <iostream>

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();

  // Any DecomposedProblem will do; this one comes from a scene, 4 x 4 subdomains a body.
  const epafi::scene::Scene scene = epafi::scene::modelProblem(true, 4, 32);
  epafi::model::Decomposition cut = epafi::model::decompose(scene, comm);

  Teuchos::ParameterList parameters("Solver");
  parameters.set("Tolerance", 1e-10);
  epafi::ContactSolver solver(parameters);
  solver.setup(cut.problem, cut.data); // factorises; once a matrix
  epafi::fetidp::ContactSolution solution = solver.solve(cut.data);

  // Other loads, supports or gaps need no new setup, and the last multipliers are a good start.
  cut.data.scaleLoads(1.1);
  solution = solver.solve(cut.data, solution.multiplier.get());
  if (comm->getRank() == 0)
    std::cout << std::setprecision(12) << toString(solver.report().status) << ", energy " << solution.energy
              << ", " << solution.activeContactNodes << " closed nodes, "
              << solver.report().counts.hessianMultiplications << " products with F\n";
}
