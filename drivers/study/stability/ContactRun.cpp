#include "ContactRun.hpp"

#include "UndecomposedSolution.hpp"

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_ArrayRCP.hpp>
#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace epafi::drivers {
namespace {

using decomposition::DecomposedProblem;

constexpr double secondsOfIteration = 60;

/// What is allowed of a solution to the tolerance ε on the dual residual, ‖r‖ ≤ ε‖d̃‖. Its error in the
/// energy norm is rᵀF⁻¹r, relative to d̃ᵀF⁻¹d̃ no more than ε²κ(F); κ(F) grows with the contrast of materials
/// and with H/h: up to 1e4 times the contrast here. No less is asked for than 100 times the error of sparse
/// LU without refinement.
struct Allowance {
  Allowance(double tolerance, double contrast)
      : balance(std::max(100 * tolerance * std::sqrt(std::max(contrast, 1 / contrast)), 1e-8)),
        penetration(std::max(1000 * tolerance, 1e-7)), complementarity(std::max(100 * tolerance, 1e-8)),
        energyNorm(std::max(1e4 * tolerance, balance)) {}

  double balance;     ///< a dual energy norm too
  double penetration; ///< as ContactSolver promises
  double complementarity;
  double energyNorm;
};

void sum(const Comm& comm, Eigen::VectorXd& values) {
  sumOverRanks(comm, {values.data(), static_cast<std::size_t>(values.size())});
}

/// Values of each body at its nodes, on every rank: the mean of the copies of a node, weighted by their
/// stiffness as the rows of gluing weigh them. Collective.
std::vector<Eigen::VectorXd> nodalValues(const model::Decomposition& decomposition,
                                         const fetidp::ContactSolution& solution) {
  const auto& problem = decomposition.problem;
  const Eigen::Index n = problem.components;
  std::vector<Eigen::VectorXd> sums, weights;
  for (const auto& body : decomposition.bodies)
    sums.emplace_back(Eigen::VectorXd::Zero(n * static_cast<Eigen::Index>(body.mesh->numNodes())));
  weights = sums;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    const std::size_t body = subdomain.body;
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(subdomain.nodes.size()));
    for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i)
      stiffness[subdomain.unknownPosition[i] / n] +=
          subdomain.stiffness->coeff(static_cast<int>(i), static_cast<int>(i));
    for (Eigen::Index k = 0; k < stiffness.size(); ++k) {
      const double weight = stiffness[k] > 0 ? stiffness[k] : 1.0;
      const Eigen::Index at = n * static_cast<Eigen::Index>(subdomain.nodes[k]);
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

/// λ of contact and ties on every rank. Collective.
Eigen::VectorXd contactForces(const decomposition::DecomposedProblem& problem, const Vector& multiplier) {
  Eigen::VectorXd forces =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.numInequalities + problem.numTies));
  const auto values = multiplier.getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i) {
    const auto row = static_cast<LocalOrdinal>(i);
    if (problem.kindOf(decomposition::OwnedMultiplier(row)) != decomposition::RowKind::gluing)
      forces[problem.multiplierMap->getGlobalElement(row)] = values[i];
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
std::string inspect(const scene::Scene& scene, const model::Decomposition& decomposition,
                    const fetidp::ContactSolution& solution, bool hasReference, Allowance allowance,
                    CaseResult& result) {
  const std::vector<Eigen::VectorXd> values = nodalValues(decomposition, solution);
  const Eigen::VectorXd forces = contactForces(decomposition.problem, *solution.multiplier);
  const UndecomposedSystem system = undecomposedSystem(scene);
  const Eigen::VectorXd u = system.unknownsOf(values);
  const Optimality optimality = optimalityOf(system, u, forces);
  result.balance = optimality.balance;
  result.penetration = optimality.penetration;
  result.complementarity = optimality.complementarity;
  if (hasReference) {
    try {
      const UndecomposedSolution reference = solveUndecomposed(system);
      result.energyError = energyNormError(system, u, reference.unknowns);
      allowance.energyNorm = std::max(allowance.energyNorm, 100 * reference.roundOff);
    } catch (const std::runtime_error&) { // a step of the active sets leaves a body loose: no reference
    }
  }
  return complaint(result, optimality.tension, allowance);
}

/// With friction, of which the undecomposed problem knows nothing: the solver's own residuals, each force
/// within its law, and, from rest and without gaps, that the loads' work is twice the strain energy and what
/// friction takes. Collective.
std::string inspectFriction(const model::Decomposition& decomposition,
                            const fetidp::ContactSolution& solution, const Allowance& allowance,
                            CaseResult& result) {
  const DecomposedProblem& problem = decomposition.problem;
  result.penetration = solution.feasibility;
  result.complementarity = solution.complementarity;
  result.balance = solution.relativeProjectedGradient;
  double outside = 0, largest = 0;
  const auto force = solution.multiplier->getData();
  for (const decomposition::FrictionNode& node : problem.frictionNodes) {
    const LocalOrdinal first = node.firstTangent, contact = node.contact;
    const double along =
        problem.components == 2 ? std::abs(force[first]) : std::hypot(force[first], force[first + 1]);
    outside =
        std::max({outside, -force[contact], along - decomposition.data.frictionBound(node, force[contact])});
    largest = std::max(largest, std::abs(force[contact]));
  }
  outside = maxOverRanks(*problem.comm, outside);
  largest = maxOverRanks(*problem.comm, largest);
  std::string wrong = complaint(result, outside - 1e-9 * largest, allowance);
  const double work = solution.loadWork, spent = 2 * (solution.energy + work) + solution.dissipation;
  if (decomposition.data.gap().normInf() == 0 &&
      !(std::abs(work - spent) <= 10 * allowance.complementarity * std::abs(work)))
    wrong += " the loads' work is " + std::to_string(work) + ", but " + std::to_string(spent) + " is spent";
  return wrong;
}

/// Two rows of B for the same nodes that ask for opposite things.
void contradict(DecomposedProblem& problem) {
  for (auto& subdomain : problem.subdomains) {
    auto& rows = subdomain.constraint;
    const int first = problem.multiplierGhostMap->getLocalElement(0),
              second = problem.multiplierGhostMap->getLocalElement(1);
    if (first < 0 || second < 0)
      continue;
    std::erase_if(rows, [&](const auto& entry) { return entry.multiplier == second; });
    const auto copy = rows;
    for (const auto& entry : copy)
      if (entry.multiplier == first)
        rows.push_back({second, entry.unknown, -entry.coefficient});
  }
}

/// Writes one number into what `what` names, on the rank that has it.
void write(const std::string& what, double value, model::Decomposition& decomposition) {
  DecomposedProblem& problem = decomposition.problem;
  std::vector<decomposition::SubdomainData> data(decomposition.data.subdomains().begin(),
                                                 decomposition.data.subdomains().end());
  Vector gap(decomposition.data.gap(), Teuchos::Copy);
  if (what == "gap" && problem.multiplierMap->isNodeGlobalElement(1))
    gap.replaceGlobalValue(1, value);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    decomposition::Subdomain& subdomain = problem.subdomains[s];
    if (what == "constraint row" && !subdomain.constraint.empty())
      subdomain.constraint[0].coefficient = value;
    if (what == "load" && subdomain.number == 1)
      data[s].load[0] = value;
    if (what == "stiffness" && subdomain.number == 1) {
      const auto matrix = std::make_shared<decomposition::SparseMatrix>(*subdomain.stiffness);
      matrix->coeffRef(3, 3) = value;
      subdomain.stiffness = matrix;
    }
  }
  decomposition.data = decomposition::ProblemData(std::move(data), gap, Vector(gap.getMap()));
}

/// The pressed squares as membranes in one place, each of which is to lie above the other one by 1: along one
/// edge the first, along the next one the second.
void layCrosswise(scene::Scene& scene) {
  for (scene::Body& body : scene.bodies) {
    body.physics = fem::Physics::membrane;
    body.mesh.box = scene.bodies[0].mesh.box;
    body.supports = {{"wall", "right", {0.0}}};
    body.loads.clear();
  }
  scene.contacts = {{"joint", 1, "left", 0, "left", {}, -1}, {"back", 0, "bottom", 1, "bottom", {}, -1}};
}

CaseResult solve(const Case& which, const RCP<const Comm>& comm) {
  Teuchos::ParameterList given = which.list;
  const double tolerance = given.get("Tolerance", 1e-8);
  const std::string application = given.get("Application", "");
  scene::Scene scene = scene::readScene(which.scene(), "scene.xml");
  for (scene::Body& body : scene.bodies)
    for (fem::SolidLoad& load : body.loads)
      for (double& component : load.value)
        component *= given.get("Unit of Loads", 1.0);
  const bool isScene = application.empty() || application.starts_with("two membranes");
  if (isScene && !application.empty())
    layCrosswise(scene);

  Teuchos::ParameterList& parameters = given.sublist("Solver");
  parameters.set("Tolerance", tolerance).set("Equilibrium Tolerance", tolerance);
  parameters.sublist("MPRGP").set("Time Limit", secondsOfIteration);
  ContactSolver solver(parameters);
  model::Decomposition decomposition = model::decompose(scene, comm);
  if (application == "contradictory rows") {
    contradict(decomposition.problem);
    write("gap", -1.0, decomposition);
  } else if (!isScene) {
    write(application, given.get("Number", 0.0), decomposition);
  }
  solver.setup(decomposition.problem, decomposition.data);
  fetidp::ContactSolution solution = solver.solve(decomposition.data);
  const double energy = solution.energy;
  for (int again = 0; again < 3 && given.get("Check", "") == "start from the solution"; ++again) {
    const RCP<Vector> start = solution.multiplier;
    solution = solver.solve(decomposition.data, start.get());
  }

  CaseResult result;
  const qp::SolveReport& report = solver.report();
  result.outcome = report.status == qp::Status::converged ? Outcome::solved : Outcome::stopped;
  result.status = qp::toString(report.status);
  result.reason = report.reason;
  result.products = report.counts.hessianMultiplications;
  result.normProducts = solver.dualProblem().norm().multiplications;
  result.projectedGradient = solution.relativeProjectedGradient;
  result.energy = solution.energy;
  result.force = solution.contactForce;
  result.active = static_cast<long long>(solution.activeContactNodes);
  const Allowance allowance(tolerance, given.get("Contrast", 1.0));
  std::string wrong;
  if (decomposition.problem.numFriction > 0) {
    wrong = inspectFriction(decomposition, solution, allowance, result);
  } else if (isScene) {
    wrong = inspect(scene, decomposition, solution, given.get("Reference Solution", "") != "no", allowance,
                    result);
  } else {
    result.penetration = solution.feasibility;
    result.complementarity = solution.complementarity;
    result.balance = solution.relativeProjectedGradient;
    wrong = complaint(result, 0.0, allowance);
  }
  result.judge(wrong.empty() ? "" : "it is claimed to be solved, but: " + wrong);
  if (!(std::abs(result.energy - energy) <= 1e-6 * std::abs(energy)))
    result.judge("started from the solution, the energy changes from " + std::to_string(energy));
  return result;
}

/// What `found` should share with a reference; empty if it does.
std::string difference(const CaseResult& found, const CaseResult& reference, double unit) {
  std::ostringstream text;
  if (const double energy = found.energy / unit / reference.energy; !(std::abs(energy - 1) < 1e-6))
    text << "the energy is " << energy << " of that of the reference; ";
  if (found.active != reference.active)
    text << found.active << " closed nodes, not " << reference.active << "; ";
  if (std::abs(found.products - reference.products) > reference.products / 5)
    text << found.products << " products, not " << reference.products << "; ";
  return text.str();
}

} // namespace

CaseResult runContact(const Case& which, const RCP<const Comm>& comm) {
  CaseResult result = solve(which, comm);
  Teuchos::ParameterList given = which.list;
  if (const double active = given.get("Closed Nodes", unknown);
      !std::isnan(active) && static_cast<double>(result.active) != active)
    result.judge("closed nodes: " + std::to_string(result.active) + ", not " +
                 std::to_string(std::lround(active)));
  if (given.isSublist("Reference")) {
    Case reference = which;
    reference.list = which.list.sublist("Reference");
    result.judge(difference(result, solve(reference, comm), given.get("Unit of Energy", 1.0)));
  }
  if (given.get("Check", "") == "on one rank too") {
    const CaseResult alone = solve(which, comm->split(comm->getRank(), 0));
    std::ostringstream text;
    if (!(std::abs(result.energy - alone.energy) <= 1e-9 * std::abs(alone.energy)) ||
        !(std::abs(result.force - alone.force) <= 1e-6 * std::abs(alone.force)) ||
        result.active != alone.active)
      text << "energy, force and closed nodes are " << result.energy << ", " << result.force << ", "
           << result.active << " on " << comm->getSize() << " ranks and " << alone.energy << ", "
           << alone.force << ", " << alone.active << " on one";
    result.judge(text.str());
  }
  return result;
}

} // namespace epafi::drivers
