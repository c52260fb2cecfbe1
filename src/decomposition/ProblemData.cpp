#include "epafi/decomposition/ProblemData.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Text.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

RCP<Vector> copyOf(const RCP<Vector>& vector) {
  return vector.is_null() ? vector : rcp(new Vector(*vector, Teuchos::Copy));
}

/// \param what  for messages
void enterFriction(const DecomposedProblem& problem, std::span<const double> values, const std::string& what,
                   Vector& target) {
  collectively(*problem.comm, [&] {
    if (values.size() != problem.frictionNodes.size())
      throw InputError("there are " + std::to_string(values.size()) + " numbers for " +
                       std::to_string(problem.frictionNodes.size()) + " nodes with friction of this rank.");
    for (std::size_t node = 0; node < values.size(); ++node) {
      if (!(values[node] >= 0) || !std::isfinite(values[node]))
        throw InputError(what + " is " + text(values[node]) + "; it must be a finite number, at least 0.");
      target.replaceLocalValue(problem.frictionNodes[node].firstTangent, values[node]);
    }
  });
}

} // namespace

ProblemData::ProblemData(std::vector<SubdomainData> subdomains, const Vector& gaps, const Vector& held)
    : subdomains_(std::move(subdomains)), gap_(rcp(new Vector(gaps, Teuchos::Copy))),
      held_(rcp(new Vector(held, Teuchos::Copy))), bounds_(rcp(new Vector(gaps.getMap()))),
      coefficients_(rcp(new Vector(gaps.getMap()))) {
  gap_->update(-1.0, *held_, 1.0);
}

ProblemData::ProblemData(const ProblemData& other)
    : subdomains_(other.subdomains_), gap_(copyOf(other.gap_)), held_(copyOf(other.held_)),
      bounds_(copyOf(other.bounds_)), coefficients_(copyOf(other.coefficients_)),
      hasCoulombFriction_(other.hasCoulombFriction_) {}

ProblemData& ProblemData::operator=(const ProblemData& other) {
  return *this = ProblemData(other);
}

void ProblemData::scaleLoads(double factor) {
  for (SubdomainData& data : subdomains_) {
    data.load *= factor;
    data.heldLoad *= std::abs(factor);
    data.heldForces *= factor;
    data.heldWork *= factor;
  }
}

void ProblemData::scaleSupports(double factor) {
  for (SubdomainData& data : subdomains_) {
    data.reaction *= factor;
    data.prescribed *= factor;
    data.heldWork *= factor;
    data.heldEnergy *= factor * factor;
  }
  gap_->update(1.0 - factor, *held_, 1.0);
  held_->scale(factor);
}

void ProblemData::setLoad(const DecomposedProblem& problem, std::size_t subdomain,
                          const Eigen::VectorXd& forces) {
  if (subdomain >= subdomains_.size() || forces.size() != subdomains_[subdomain].prescribed.size())
    throw InputError("forces of " + std::to_string(forces.size()) + " numbers were given for subdomain " +
                     std::to_string(subdomain) + " of this rank's " + std::to_string(subdomains_.size()) +
                     "; there must be one for each component of each of its nodes.");
  SubdomainData& data = subdomains_[subdomain];
  data.load = loadOf(problem.subdomains[subdomain], forces);
  const Eigen::VectorXd held = heldPart(problem.subdomains[subdomain], forces);
  data.heldLoad = held.lpNorm<1>();
  data.heldWork = held.dot(data.prescribed);
  if (data.heldForces.size() > 0)
    data.heldForces = held(problem.subdomains[subdomain].held.positions);
}

void ProblemData::setGaps(const Vector& gaps) {
  const auto values = gaps.getData(), held = held_->getData();
  const auto target = gap_->getDataNonConst();
  for (LocalOrdinal i = 0; i < values.size(); ++i) {
    const LocalOrdinal row = gap_->getMap()->getLocalElement(gaps.getMap()->getGlobalElement(i));
    if (row < 0)
      throw InputError("a gap was given for row " + std::to_string(gaps.getMap()->getGlobalElement(i)) +
                       ", which this rank does not own.");
    target[row] = values[i] - held[row];
  }
}

double ProblemData::frictionBound(const FrictionNode& node, double normalForce) const {
  return bounds_->getData()[node.firstTangent] +
         coefficients_->getData()[node.firstTangent] * std::max(0.0, normalForce);
}

void ProblemData::setFrictionBounds(const DecomposedProblem& problem, std::span<const double> bounds) {
  enterFriction(problem, bounds, "a bound of friction", *bounds_);
}

void ProblemData::setFrictionCoefficients(const DecomposedProblem& problem,
                                          std::span<const double> coefficients) {
  enterFriction(problem, coefficients, "a coefficient of friction", *coefficients_);
  hasCoulombFriction_ = coefficients_->normInf() > 0;
}

RCP<Vector> ProblemData::contactGaps(const DecomposedProblem& problem) const {
  std::vector<GlobalOrdinal> rows;
  for (const GlobalOrdinal row : localIndices(*gap_->getMap()))
    if (problem.kindOf(MultiplierNumber(row)) == RowKind::contact)
      rows.push_back(row);
  const RCP<Vector> gaps = rcp(new Vector(makeMap(rows, problem.comm)));
  const auto values = gaps->getDataNonConst();
  const auto gap = gap_->getData(), held = held_->getData();
  for (LocalOrdinal i = 0; i < values.size(); ++i) {
    const LocalOrdinal row = gap_->getMap()->getLocalElement(gaps->getMap()->getGlobalElement(i));
    values[i] = gap[row] + held[row];
  }
  return gaps;
}

} // namespace epafi::decomposition
