#include "epafi/output/Evaluation.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/output/CellErrors.hpp"
#include "epafi/output/ContactGeometry.hpp"
#include "epafi/output/NodalStress.hpp"

#include <Teuchos_Array.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>

namespace epafi::output {
namespace {

using contact::ContactLayout;

/// Sums over the rows of one contact, in this order in what is sent.
struct ContactSums {
  AccurateSum active, force, area;
  std::array<AccurateSum, 3> resultant;
  double largestPressure = 0;
};

std::vector<ContactSums> sumOwnRows(const SolvedScene& solved, const Evaluation& evaluation) {
  const std::vector<ContactLayout>& contacts = solved.decomposition.contacts;
  const Map& map = *solved.decomposition.problem.multiplierMap;
  const auto multiplier = solved.solution.multiplier->getData();
  const auto active = solved.solution.active->getData();
  std::vector<ContactSums> sums(contacts.size());
  for (Teuchos::Ordinal i = 0; i < multiplier.size(); ++i) {
    const decomposition::MultiplierNumber index = map.getGlobalElement(static_cast<LocalOrdinal>(i));
    if (solved.decomposition.problem.kindOf(index) != decomposition::RowKind::contact)
      continue;
    const auto contact = std::find_if(contacts.begin(), contacts.end(), [index](const ContactLayout& c) {
      return index < c.firstRow + c.numRows();
    });
    const auto place = static_cast<std::size_t>(contact - contacts.begin());
    const auto row = static_cast<std::size_t>(index - contact->firstRow);
    const double force = multiplier[i], area = evaluation.areas[place][row];
    const std::array<double, 3> direction = directionOf(*contact, row);
    ContactSums& sum = sums[place];
    sum.force.add(force);
    for (std::size_t d = 0; d < 3; ++d)
      sum.resultant[d].add(-force * direction[d]);
    sum.largestPressure = std::max(sum.largestPressure, force / area);
    if (active[i] > 0.5) {
      sum.active.add(1);
      sum.area.add(area);
    }
  }
  return sums;
}

/// Collective.
void sumContacts(const Comm& comm, std::vector<ContactSums>& sums) {
  std::vector<AccurateSum> terms;
  for (const ContactSums& sum : sums)
    terms.insert(terms.end(),
                 {sum.active, sum.force, sum.area, sum.resultant[0], sum.resultant[1], sum.resultant[2]});
  sumOverRanks(comm, terms);
  const AccurateSum* next = terms.data();
  for (ContactSums& sum : sums) {
    sum.active = *next++;
    sum.force = *next++;
    sum.area = *next++;
    for (AccurateSum& component : sum.resultant)
      component = *next++;
    sum.largestPressure = maxOverRanks(comm, sum.largestPressure);
  }
}

/// Collective.
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

} // namespace

Evaluation evaluate(const SolvedScene& solved, const accuracy::ErrorEstimate* estimate) {
  Evaluation result;
  result.hasErrors = estimate != nullptr;
  for (std::size_t body = 0; body < solved.scene.bodies.size(); ++body) {
    result.vonMises.emplace_back();
    if (solved.elasticBody(static_cast<int>(body)) != nullptr)
      result.vonMises.back() = vonMisesAtNodes(solved, static_cast<int>(body));
    result.errors.emplace_back();
    if (estimate != nullptr)
      result.errors.back() = cellErrors(solved, *estimate, static_cast<int>(body));
  }
  for (std::size_t contact = 0; contact < solved.decomposition.contacts.size(); ++contact)
    result.areas.push_back(pressureAreas(solved, static_cast<int>(contact)));
  return result;
}

void addResults(const SolvedScene& solved, const Evaluation& evaluation, Teuchos::ParameterList& report) {
  const std::vector<ContactLayout>& contacts = solved.decomposition.contacts;
  std::vector<ContactSums> sums = sumOwnRows(solved, evaluation);
  sumContacts(solved.comm(), sums);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    Teuchos::Array<double> resultant;
    for (const AccurateSum& component : sums[c].resultant)
      resultant.push_back(component.value());
    report.sublist("Contact")
        .sublist(contacts[c].name)
        .set("Candidates", contacts[c].numRows())
        .set("Active Nodes", static_cast<GlobalOrdinal>(sums[c].active.value()))
        .set("Force", sums[c].force.value())
        .set("Resultant", resultant)
        .set("Largest Pressure", sums[c].largestPressure)
        .set("Contact Area", sums[c].area.value());
  }
  for (std::size_t b = 0; b < solved.scene.bodies.size(); ++b) {
    if (solved.elasticBody(static_cast<int>(b)) == nullptr)
      continue;
    const std::vector<double>& stress = evaluation.vonMises[b];
    const double largest = stress.empty() ? 0 : *std::max_element(stress.begin(), stress.end());
    report.sublist("Body")
        .sublist(solved.scene.bodies[b].name)
        .set("Largest Displacement", largestDisplacement(solved, static_cast<int>(b)))
        .set("Largest von Mises Stress", maxOverRanks(solved.comm(), largest));
  }
}

} // namespace epafi::output
