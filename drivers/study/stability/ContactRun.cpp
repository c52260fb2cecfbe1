#include "ContactRun.hpp"

#include "UndecomposedSolution.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"

#include <Teuchos_ArrayRCP.hpp>
#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace epafi::drivers {
namespace {

constexpr double secondsOfIteration = 60;

void sum(const Comm& comm, Eigen::VectorXd& values) {
  sumOverRanks(comm, {values.data(), static_cast<std::size_t>(values.size())});
}

/// Values of each body at its nodes, on every rank: the mean of the copies of a node, weighted by their stiffness as the
/// rows of gluing weigh them. Collective.
std::vector<Eigen::VectorXd> nodalValues(const decomposition::Decomposition& decomposition,
                                         const fetidp::ContactSolution& solution) {
  const auto& problem = decomposition.problem;
  const Eigen::Index n = problem.components;
  std::vector<Eigen::VectorXd> sums, weights;
  for (const auto& body : decomposition.bodies)
    sums.emplace_back(Eigen::VectorXd::Zero(n * static_cast<Eigen::Index>(body.mesh->numNodes())));
  weights = sums;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    const auto body = static_cast<std::size_t>(subdomain.body);
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(subdomain.nodes.size()));
    for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i)
      stiffness[subdomain.unknownPosition[i] / n] +=
          subdomain.stiffness->coeff(static_cast<int>(i), static_cast<int>(i));
    for (Eigen::Index k = 0; k < stiffness.size(); ++k) {
      const double weight = stiffness[k] > 0 ? stiffness[k] : 1.0;
      const Eigen::Index at = n * static_cast<Eigen::Index>(subdomain.nodes[static_cast<std::size_t>(k)]);
      sums[body].segment(at, n) += weight * solution.displacement[s].segment(n * k, n);
      weights[body].segment(at, n).array() += weight;
    }
  }
  for (std::size_t body = 0; body < sums.size(); ++body) {
    sum(*problem.comm, sums[body]);
    sum(*problem.comm, weights[body]);
    sums[body].array() /= weights[body].array();
  }
  return sums;
}

/// λ_I on every rank. Collective.
Eigen::VectorXd contactForces(const decomposition::DecomposedProblem& problem, const Vector& multiplier) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.numInequalities));
  const auto values = multiplier.getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i) {
    const GlobalOrdinal row = problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i));
    if (row < problem.numInequalities)
      forces[static_cast<Eigen::Index>(row)] = values[i];
  }
  sum(*problem.comm, forces);
  return forces;
}

/// What is wrong with the residuals; empty if nothing is. A NaN is wrong.
std::string complaint(const CaseResult& result, double tension, const Allowance& allowance) {
  std::ostringstream text;
  const auto check = [&](const char* what, double value, double limit) {
    if (!(value <= limit))
      text << (text.str().empty() ? "" : ", ") << what << ' ' << value << " > " << limit;
  };
  check("imbalance of forces", result.balance, allowance.balance);
  check("penetration", result.penetration, allowance.penetration);
  check("tension", tension, 0.0);
  check("complementarity", result.complementarity, allowance.complementarity);
  if (!std::isnan(result.energyError))
    check("error in the energy norm", result.energyError, allowance.energyNorm);
  return text.str();
}

/// Fills what is recomputed from u and λ on the undecomposed problem; returns what is wrong.
std::string inspect(const ContactTask& task, const decomposition::Decomposition& decomposition,
                    const fetidp::ContactSolution& solution, CaseResult& result) {
  const std::vector<Eigen::VectorXd> values = nodalValues(decomposition, solution);
  const Eigen::VectorXd forces = contactForces(decomposition.problem, *solution.multiplier);
  const UndecomposedSystem system = undecomposedSystem(task.scene);
  const Eigen::VectorXd u = system.unknownsOf(values);
  const Optimality optimality = optimalityOf(system, u, forces);
  result.balance = optimality.balance;
  result.penetration = optimality.penetration;
  result.complementarity = optimality.complementarity;
  Allowance allowance = allowanceOf(task.tolerance, task.contrast);
  if (task.hasReference) {
    try {
      const UndecomposedSolution reference = solveUndecomposed(system);
      result.energyError = energyNormError(system, u, reference.unknowns);
      allowance.energyNorm = std::max(allowance.energyNorm, 100 * reference.roundOff);
    } catch (const std::runtime_error&) { // a step of the active sets leaves a body loose: no reference
    }
  }
  return complaint(result, optimality.tension, allowance);
}

} // namespace

Teuchos::ParameterList plainMethod() {
  Teuchos::ParameterList list;
  list.sublist("Preconditioner").set("Type", "none");
  return list;
}

Allowance allowanceOf(double tolerance, double contrast) {
  const double inEnergy = 100 * tolerance * std::sqrt(contrast);
  return {std::max(inEnergy, 1e-8), std::max(1000 * tolerance, 1e-7), std::max(100 * tolerance, 1e-8),
          std::max({1e4 * tolerance, inEnergy, 1e-8})};
}

CaseResult solveContact(const ContactTask& task, const RCP<const Comm>& comm) {
  Teuchos::ParameterList parameters = task.solver;
  parameters.set("Tolerance", task.tolerance).set("Equilibrium Tolerance", task.tolerance);
  parameters.sublist("MPRGP").set("Time Limit", secondsOfIteration);
  ContactSolver solver(parameters);
  decomposition::Decomposition decomposition = decomposition::decompose(task.scene, comm);
  if (task.change)
    task.change(decomposition.problem);
  solver.setup(decomposition.problem);
  const fetidp::ContactSolution solution = solver.solve();

  CaseResult result;
  const qp::SolveReport& report = solver.report();
  result.status = qp::toString(report.status);
  result.reason = report.reason;
  result.products = report.counts.hessianMultiplications;
  result.normProducts = solver.dualProblem().norm().multiplications;
  result.projectedGradient = solution.relativeProjectedGradient;
  result.energy = solution.energy;
  result.force = solution.contactForce;
  result.active = static_cast<long long>(solution.activeContactNodes);
  std::string wrong;
  if (task.change) {
    result.penetration = solution.feasibility;
    result.complementarity = solution.complementarity;
    result.balance = solution.relativeProjectedGradient;
    wrong = complaint(result, 0.0, allowanceOf(task.tolerance, task.contrast));
  } else {
    wrong = inspect(task, decomposition, solution, result);
  }
  if (report.status != qp::Status::converged) {
    result.outcome = Outcome::stopped;
  } else if (!wrong.empty()) {
    result.outcome = Outcome::wrongAnswer;
    result.reason = "it is claimed to be solved, but: " + wrong;
  } else {
    result.outcome = Outcome::solved;
  }
  return result;
}

} // namespace epafi::drivers
