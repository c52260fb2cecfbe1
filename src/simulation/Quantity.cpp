#include "epafi/simulation/Quantity.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/simulation/JointResults.hpp"
#include "epafi/simulation/LargestPressure.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace epafi::simulation {
namespace {

/// Residual of the dual problem at which its solution still serves, should round-off allow no less: meshes
/// have larger errors.
constexpr double enoughOfDual = 1e-3;

/// Estimates of coarse meshes see 0.7 of the error.
constexpr double safety = 1.5;

const std::vector<std::string> kinds{"none", "force", "displacement", "pressure"};

[[noreturn]] void refuse(const std::string& objection) {
  throw InputError("list \"Accuracy/Quantity\" " + objection);
}

/// The place of a name among those of some things. \throws InputError that suggests the nearest one.
template <class Things>
std::size_t placeOf(const std::string& name, const Things& things, const std::string& what) {
  std::vector<std::string> names;
  for (const auto& thing : things)
    names.push_back(thing.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    const std::string near = nearestName(name, names);
    refuse("asks for " + what + " '" + name + "', which the scene does not have" +
           (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  return found - names.begin();
}

} // namespace

void QuantityParameters::addTo(Teuchos::ParameterList& accuracy) {
  Teuchos::ParameterList& list =
      accuracy.sublist("Quantity", false,
                       "The number that the scene is solved for: it is reported with an error bar, and a "
                       "Target is relative to it, not to the "
                       "energy norm.");
  addChoice(
      list, "Kind", kinds.front(),
      "force: the size of a contact's resultant. pressure: its largest one. displacement: averaged over "
      "a surface of a body, or at a point of it.",
      kinds);
  list.set("Contact", "", "Kinds force and pressure, required: the contact.");
  list.set("Body", "", "Kind displacement, required: the body.");
  list.set("Surface", "", "Kind displacement: the surface to average over.");
  addArray(list, "Point", Teuchos::Array<double>(),
           "Kind displacement, unless there is a surface: the point in the undeformed body.",
           "{x, y} or {x, y, z}");
  addArray(list, "Direction", Teuchos::Array<double>(),
           "Kind displacement of elastic bodies, required: along what it is measured, of any length but 0.",
           "{x, y} or {x, y, z}");
}

QuantityParameters QuantityParameters::from(const Teuchos::ParameterList& list) {
  QuantityParameters parameters;
  parameters.kind = enumeratorFrom<Kind>(list, "Kind", kinds);
  parameters.contact = list.get<std::string>("Contact");
  parameters.body = list.get<std::string>("Body");
  parameters.surface = list.get<std::string>("Surface");
  parameters.point = list.get<Teuchos::Array<double>>("Point").toVector();
  parameters.direction = list.get<Teuchos::Array<double>>("Direction").toVector();
  const bool isOfContact = parameters.kind == Kind::force || parameters.kind == Kind::pressure,
             namesContact = !parameters.contact.empty(),
             asksDisplacementOf = !parameters.body.empty() || !parameters.surface.empty() ||
                                  !parameters.point.empty() || !parameters.direction.empty();
  if (!isOfContact && namesContact)
    refuse("names a contact, which goes with the kinds \"force\" and \"pressure\" alone");
  if (parameters.kind != Kind::displacement && asksDisplacementOf)
    refuse("has a body, surface, point or direction, which go with the kind \"displacement\" alone");
  if (isOfContact && !namesContact)
    refuse("is of the kind \"" + kinds[static_cast<std::size_t>(parameters.kind)] +
           "\", and needs a \"Contact\"");
  if (parameters.kind == Kind::displacement &&
      (parameters.body.empty() || parameters.surface.empty() == parameters.point.empty()))
    refuse("is of the kind \"displacement\", and needs a \"Body\", and either a \"Surface\" or a \"Point\"");
  return parameters;
}

QuantityOfScene::QuantityOfScene(const QuantityParameters& parameters, const scene::Scene& scene,
                                 const model::Decomposition& decomposition)
    : decomposition_(decomposition), kind_(parameters.kind) {
  if (kind_ != Kind::displacement) {
    placeOf(parameters.contact, scene.contacts, "contact");
    contact_ =
        &decomposition
             .contacts[placeOf(parameters.contact, decomposition.contacts, "a contact that is no joint,")];
    name_ = (kind_ == Kind::force ? "force of contact '" : "largest pressure of contact '") +
            parameters.contact + "'";
    return;
  }
  accuracy::DisplacementTerms terms;
  terms.body = static_cast<int>(placeOf(parameters.body, scene.bodies, "body"));
  terms.surface = parameters.surface;
  const std::size_t dimension = dimensionOf(scene.bodies.front().physics);
  const auto isVector = [&](const std::vector<double>& x) {
    return x.size() == dimension &&
           std::all_of(x.begin(), x.end(), [](double c) { return std::isfinite(c); });
  };
  if (terms.surface.empty() && !isVector(parameters.point))
    refuse("needs a \"Point\" of " + std::to_string(dimension) + " finite numbers");
  std::copy(parameters.point.begin(), parameters.point.end(), terms.point.begin());
  if (scene.bodies.front().physics == fem::Physics::membrane) {
    if (!parameters.direction.empty())
      refuse("has a \"Direction\", and membranes deflect along z alone");
  } else {
    terms.direction.setZero();
    if (isVector(parameters.direction))
      std::copy(parameters.direction.begin(), parameters.direction.end(), terms.direction.begin());
    if (!(terms.direction.norm() > 0))
      refuse("needs a \"Direction\" of " + std::to_string(dimension) + " finite numbers, not all of them 0");
  }
  weights_ = accuracy::displacementWeights(decomposition, terms);
  name_ = "displacement of body '" + parameters.body + "' " +
          (terms.surface.empty() ? "at the point" : "over '" + terms.surface + "'");
}

fetidp::DataChange QuantityOfScene::evaluate(const SolvedScene& solved, Quantity& quantity) const {
  const decomposition::DecomposedProblem& problem = decomposition_.problem;
  fetidp::DataChange change;
  if (contact_ != nullptr) {
    if (kind_ == Kind::force) {
      const ContactForce force = contactForce(solved, *contact_);
      quantity.value = force.value;
      change.gap = force.weights;
    } else {
      const LargestPressure pressure = largestPressure(solved, *contact_);
      quantity.value = pressure.value;
      quantity.remainder = pressure.remainder;
      quantity.width = pressure.width;
      change.gap = pressure.weights;
    }
    for (const decomposition::Subdomain& subdomain : problem.subdomains)
      change.load.emplace_back(Eigen::VectorXd::Zero(subdomain.stiffness->rows()));
    if (quantity.value == 0)
      quantity.failure = "the contact carries no force";
    else if (kind_ == Kind::force && !contact_->note.empty())
      quantity.failure = "its force is shared with another joint: " + contact_->note;
    return change;
  }
  std::array<AccurateSum, 2> sums; // of the terms, and of the weights' magnitudes
  double largest = 0;
  for (std::size_t s = 0; s < weights_.size(); ++s) {
    const Eigen::VectorXd& u = solved.solution.displacement[s];
    sums[0].add(weights_[s].dot(u));
    sums[1].add(weights_[s].cwiseAbs().sum());
    largest = std::max(largest, u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0);
    change.load.push_back(decomposition::loadOf(problem.subdomains[s], weights_[s]));
  }
  sumOverRanks(*problem.comm, sums);
  quantity.value = sums[0].value();
  constexpr double roundOff = 1e-13;
  if (std::abs(quantity.value) <= roundOff * sums[1].value() * maxOverRanks(*problem.comm, largest)) {
    quantity.value = 0;
    quantity.failure = "it is 0 to round-off, of which an error is no share";
  }
  return change;
}

Quantity QuantityOfScene::operator()(const ContactSolver& solver, const SolvedScene& solved,
                                     accuracy::ErrorEstimator& estimator,
                                     const accuracy::ErrorEstimate& estimate) const {
  Quantity quantity;
  quantity.name = name_;
  const fetidp::DataChange change = evaluate(solved, quantity);
  if (solver.report().status == qp::Status::interrupted)
    quantity.failure = "the iteration was stopped";
  else if (quantity.failure.empty() && decomposition_.problem.numFriction > 0)
    quantity.failure = "there is friction, of which its dual problem knows nothing";
  if (!quantity.failure.empty())
    return quantity;
  fetidp::ContactResponse dual;
  try {
    dual = solver.respond(solved.solution, change);
    if (!(dual.report.relativeProjectedGradient <= enoughOfDual))
      quantity.failure = "its dual problem was not solved: " + dual.report.reason;
  } catch (const Error& error) { // on all ranks
    quantity.failure = std::string("it has no dual solution: ") + error.what();
  }
  if (!quantity.failure.empty())
    return quantity;
  accuracy::QuantityError error = accuracy::quantityError(*decomposition_.problem.comm, estimator, estimate,
                                                          solved.solution.displacement, dual.displacement);
  quantity.error = error.error;
  quantity.bar = safety * error.bar + quantity.remainder;
  quantity.elements = std::move(error.elements);
  quantity.multiplications = dual.report.counts.hessianMultiplications;
  if (std::isfinite(solved.solution.algebraicError))
    quantity.algebraic = solved.solution.algebraicError * error.dualNorm;
  return quantity;
}

} // namespace epafi::simulation
