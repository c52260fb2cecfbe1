#include "epafi/simulation/Evaluation.hpp"
#include "epafi/simulation/JointResults.hpp"

#include "epafi/accuracy/RecoveredFlux.hpp"
#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Maps.hpp"

#include <Tpetra_Export.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace epafi::simulation {
namespace {

using contact::ContactLayout;
using decomposition::Subdomain;

constexpr std::size_t numStresses = 6;

/// Nodes of this rank's subdomains of a body, each once. Collective.
RCP<const Map> nodesOfBody(const decomposition::DecomposedProblem& problem, int body) {
  std::vector<GlobalOrdinal> nodes;
  for (const Subdomain& subdomain : problem.subdomains)
    if (subdomain.body == body)
      nodes.insert(nodes.end(), subdomain.nodes.begin(), subdomain.nodes.end());
  return makeMap(std::move(nodes), problem.comm);
}

/// Adds up over all materials around a node.
void addSubdomain(const accuracy::SubdomainFlux& flux, const Subdomain& subdomain, MultiVector& sums) {
  for (std::size_t k = 0; k <= numStresses; ++k) {
    const auto column = sums.getDataNonConst(k);
    for (Eigen::Index slot = 0; slot < flux.values.cols(); ++slot) {
      const GlobalOrdinal node = subdomain.nodes[flux.nodeOf(slot)];
      column[sums.getMap()->getLocalElement(node)] += flux.values(k, slot);
    }
  }
}

/// Sums over the rows of one contact, one after the other.
enum Term : std::size_t { active, force, area, resultant, numTerms = resultant + 3 };

/// numTerms of each contact. Collective.
std::vector<AccurateSum> sumContacts(const SolvedScene& solved, const Evaluation& evaluation) {
  const std::vector<ContactLayout>& contacts = solved.decomposition.contacts;
  const Map& map = *solved.decomposition.problem.multiplierMap;
  const auto multiplier = solved.solution.multiplier->getData();
  const auto isActive = solved.solution.active->getData();
  std::vector<AccurateSum> sums(contacts.size() * numTerms);
  for (LocalOrdinal i = 0; i < multiplier.size(); ++i) {
    const decomposition::MultiplierNumber index = map.getGlobalElement(i);
    if (solved.decomposition.problem.kindOf(index) != decomposition::RowKind::contact)
      continue;
    for (std::size_t place = 0; place < contacts.size(); ++place) {
      const ContactLayout& contact = contacts[place];
      if (index < contact.firstRow || index >= contact.firstRow + contact.numRows())
        continue;
      const std::size_t row = index - contact.firstRow;
      const double portion = contact.portion(row), rowForce = portion * multiplier[i];
      if (portion == 0)
        continue;
      const Eigen::Vector3d direction = contact.spatialDirectionOf(row);
      AccurateSum* const terms = &sums[place * numTerms];
      terms[force].add(rowForce);
      const bool areSwapped = contact.firstBody != solved.scene.contacts[contact.number].first;
      for (std::size_t d = solved.isOfRevolution() ? 1 : 0; d < 3; ++d)
        terms[resultant + d].add((areSwapped ? rowForce : -rowForce) * direction[d]);
      if (isActive[i] > 0.5) {
        terms[active].add(1);
        terms[area].add(evaluation.contacts[place].areas[row]);
      }
    }
  }
  sumOverRanks(solved.comm(), sums);
  return sums;
}

/// As stressesAtNodes, of a body that is made of what `asked` is. Collective.
std::vector<fem::SymmetricTensor> tensorsAtNodes(const SolvedScene& solved, int body,
                                                 const scene::Body& asked) {
  const std::size_t place = body;
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  const model::BodyLayout& layout = solved.decomposition.bodies[place];
  MultiVector sums(nodesOfBody(problem, body), numStresses + 1);
  collectively(*problem.comm, [&] {
    accuracy::BodyElements elements(asked, layout);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
      if (problem.subdomains[s].body == body)
        addSubdomain(sumFlux(elements, problem.subdomains[s], solved.solution.displacement[s]),
                     problem.subdomains[s], sums);
  });
  MultiVector slab(slabMap(layout.mesh->numNodes(), problem.comm), numStresses + 1);
  slab.doExport(sums, Export(sums.getMap(), slab.getMap()), Tpetra::ADD);

  std::vector<Teuchos::ArrayRCP<const double>> columns;
  for (std::size_t k = 0; k <= numStresses; ++k)
    columns.push_back(slab.getData(k));
  std::vector<fem::SymmetricTensor> result(slab.getLocalLength());
  for (Teuchos::Ordinal row = 0; row < columns[0].size(); ++row)
    for (std::size_t k = 0; k < numStresses; ++k)
      result[row][k] = columns[k][row] / columns[numStresses][row];
  return result;
}

} // namespace

std::vector<fem::SymmetricTensor> stressesAtNodes(const SolvedScene& solved, int body) {
  return tensorsAtNodes(solved, body, solved.scene.bodies[body]);
}

std::vector<fem::SymmetricTensor> strainsAtNodes(const SolvedScene& solved, int body) {
  scene::Body unit = solved.scene.bodies[body]; // whose stresses are strains
  unit.material = {.youngsModulus = 1, .poissonsRatio = 0, .thickness = unit.material.thickness};
  unit.regions.clear();
  unit.loads.clear();
  return tensorsAtNodes(solved, body, unit);
}

std::vector<double> vonMisesAtNodes(const SolvedScene& solved, int body) {
  std::vector<double> result;
  for (const fem::SymmetricTensor& stress : stressesAtNodes(solved, body))
    result.push_back(fem::vonMisesOf(stress));
  return result;
}

std::vector<double> cellErrors(const SolvedScene& solved, const accuracy::ErrorEstimate& estimate, int body) {
  const auto& problem = solved.decomposition.problem;
  const auto& layout = solved.decomposition.bodies[body];
  std::vector<GlobalOrdinal> cells;
  std::vector<double> errors;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    if (problem.subdomains[s].body != body)
      continue;
    const auto here = layout.partition->elementsOf(problem.subdomains[s].number - layout.firstSubdomain);
    cells.insert(cells.end(), here.begin(), here.end());
    for (const double squared : estimate.elements[s])
      errors.push_back(std::sqrt(squared));
  }
  const auto source = mapInOrder(cells, problem.comm);
  const auto target = slabMap(layout.mesh->numElements(), problem.comm);
  const Vector mine(source, Teuchos::arrayViewFromVector(errors));
  Vector slab(target);
  slab.doImport(mine, Import(source, target), Tpetra::INSERT);
  const auto values = slab.getData();
  return {values.begin(), values.end()};
}

Evaluation evaluate(const SolvedScene& solved, const accuracy::ErrorEstimate* estimate) {
  Evaluation result;
  result.hasErrors = estimate != nullptr;
  for (int body = 0; body < std::ssize(solved.scene.bodies); ++body) {
    result.vonMises.emplace_back();
    if (solved.elasticBody(body) != nullptr)
      result.vonMises.back() = vonMisesAtNodes(solved, body);
    result.errors.emplace_back();
    if (estimate != nullptr)
      result.errors.back() = cellErrors(solved, *estimate, body);
  }
  for (int contact = 0; contact < std::ssize(solved.decomposition.contacts); ++contact)
    result.contacts.push_back(contactState(solved, contact));
  return result;
}

double largestDisplacement(const SolvedScene& solved, int body) {
  const auto& problem = solved.decomposition.problem;
  double largest = 0;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    if (problem.subdomains[s].body == body && solved.solution.displacement[s].size() > 0)
      largest = std::max(largest, solved.solution.displacement[s]
                                      .reshaped(problem.components, Eigen::AutoSize)
                                      .colwise()
                                      .norm()
                                      .maxCoeff());
  return maxOverRanks(*problem.comm, largest);
}

std::vector<BodyResult> bodyResults(const SolvedScene& solved, const Evaluation& evaluation) {
  std::vector<BodyResult> results;
  for (int b = 0; b < std::ssize(solved.scene.bodies); ++b) {
    const scene::Body& body = solved.scene.bodies[b];
    BodyResult& result = results.emplace_back();
    result.name = body.name;
    result.isElastic = solved.elasticBody(b) != nullptr;
    result.floats = solved.decomposition.problem.bodies[b].kernelDimension > 0;
    result.parts = solved.decomposition.bodies[b].partition->numParts();
    if (body.decomposition.method == scene::Decomposition::Method::metis)
      result.askedParts = body.decomposition.parts;
    if (!result.isElastic)
      continue;
    const std::vector<double>& stress = evaluation.vonMises[b];
    const double largest = stress.empty() ? 0 : *std::max_element(stress.begin(), stress.end());
    result.largestDisplacement = largestDisplacement(solved, b);
    result.largestStress = maxOverRanks(solved.comm(), largest);
    result.deformation = largestDeformation(solved, b);
  }
  return results;
}

std::vector<ContactResult> contactResults(const SolvedScene& solved, const Evaluation& evaluation) {
  const std::vector<ContactLayout>& contacts = solved.decomposition.contacts;
  const std::vector<AccurateSum> sums = sumContacts(solved, evaluation);
  std::vector<ContactResult> results;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto sumOf = [&](std::size_t term) { return sums[c * numTerms + term].value(); };
    ContactResult& result = results.emplace_back();
    result.name = contacts[c].name;
    result.candidates = contacts[c].ownRows().size();
    result.activeNodes = static_cast<GlobalOrdinal>(sumOf(active));
    result.force = sumOf(force);
    result.resultant = {sumOf(resultant), sumOf(resultant + 1), sumOf(resultant + 2)};
    result.largestPressure = evaluation.contacts[c].largestPressure;
    result.area = sumOf(area);
    if (!contacts[c].smoothed.empty())
      result.penetration = evaluation.contacts[c].penetration;
    result.numBent = contacts[c].numBent;
    result.note = contacts[c].note;
    if (contacts[c].secondBody >= 0)
      result.balance = balanceOf(solved, contacts[c]);
    if (contacts[c].firstFriction >= 0)
      result.friction = frictionResult(solved, contacts[c], evaluation.contacts[c].areas);
  }
  return results;
}

} // namespace epafi::simulation
