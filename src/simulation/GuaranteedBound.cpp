#include "epafi/simulation/GuaranteedBound.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/solve/Recovery.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <vector>

namespace epafi::simulation {

accuracy::EnergyBound guaranteedBound(accuracy::EnergyBounds& bounds, const ContactSolver& solver,
                                      const SolvedScene& solved) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  Vector multiplier(*solved.solution.multiplier, Teuchos::Copy);
  {
    const auto values = multiplier.getDataNonConst();
    std::vector<double> forces(problem.numInequalities, 0.0);
    const auto visit = [&](const auto& action) {
      for (LocalOrdinal i = 0; i < values.size(); ++i)
        if (const auto row = problem.numberOf(decomposition::OwnedMultiplier(i));
            row < problem.numInequalities)
          action(values[i], forces[row]);
    };
    visit([](double value, double& force) { force = value; });
    sumOverRanks(solved.comm(), std::span(forces));
    forces = bounds.contactForces(forces);
    visit([](double& value, double force) { value = force; });
  }
  return bounds(solved.solution.displacement,
                fetidp::displacementOf(solver.dualProblem(), solved.decomposition.data, multiplier));
}

} // namespace epafi::simulation
