#include "epafi/model/ContactData.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::model {

GlobalOrdinal firstEquation(const std::vector<contact::ContactLayout>& ties,
                            const decomposition::DecomposedProblem& problem) {
  GlobalOrdinal first = problem.firstTie();
  for (const contact::ContactLayout& tie : ties)
    first += tie.hasOwnRows ? tie.numRows() : 0;
  return first;
}

RCP<const Vector> complianceOf(const scene::Scene& scene, const std::vector<contact::ContactLayout>& contacts,
                               const std::vector<contact::ContactLayout>& ties,
                               const std::vector<contact::Equation>& equations,
                               const decomposition::DecomposedProblem& problem) {
  if (std::none_of(scene.contacts.begin(), scene.contacts.end(),
                   [](const scene::SurfaceContact& contact) {
                     return contact.stiffness > 0 || contact.stickSlope > 0;
                   }) &&
      std::none_of(equations.begin(), equations.end(),
                   [](const contact::Equation& equation) { return equation.stiffness > 0; }))
    return Teuchos::null;
  const RCP<Vector> compliance = rcp(new Vector(problem.multiplierMap)); // stiffness first
  const auto values = compliance->getDataNonConst();
  const GlobalOrdinal numTangents = problem.components - 1;
  const auto add = [&](const contact::ContactLayout& layout, GlobalOrdinal row, GlobalOrdinal number,
                       double stiffness) {
    if (const LocalOrdinal own = problem.multiplierMap->getLocalElement(number); own >= 0)
      values[own] += stiffness * layout.portion(row) * layout.areas[row];
  };
  for (const contact::ContactLayout& contact : contacts) {
    const scene::SurfaceContact& terms = scene.contacts[contact.number];
    for (GlobalOrdinal row = 0; row < contact.numRows(); ++row) {
      add(contact, row, contact.firstRow + row, terms.stiffness);
      for (GlobalOrdinal k = 0; contact.firstFriction >= 0 && k < numTangents; ++k)
        add(contact, row, problem.numInequalities + numTangents * (contact.firstFriction + row) + k,
            terms.stickSlope);
    }
  }
  for (const contact::ContactLayout& tie : ties) { // normals first
    const scene::SurfaceContact& terms = scene.contacts[tie.number];
    for (GlobalOrdinal row = 0; row < tie.numRows(); ++row)
      add(tie, row, problem.firstTie() + tie.firstRow + row,
          row < tie.numRows() / problem.components ? terms.stiffness : terms.stickSlope);
  }
  GlobalOrdinal row = firstEquation(ties, problem);
  for (const contact::Equation& equation : equations)
    if (const LocalOrdinal own = problem.multiplierMap->getLocalElement(row++); own >= 0)
      values[own] = equation.stiffness;
  for (double& value : values)
    value = value > 0 ? 1 / value : 0;
  return compliance;
}

void setFrictionData(const scene::Scene& scene, const std::vector<contact::ContactLayout>& contacts,
                     const decomposition::DecomposedProblem& problem, decomposition::ProblemData& data) {
  std::vector<double> bounds, coefficients;
  for (const decomposition::FrictionNode& node : problem.frictionNodes) {
    const GlobalOrdinal number = problem.numberOf(node.contact);
    double &bound = bounds.emplace_back(0), &coefficient = coefficients.emplace_back(0);
    for (const contact::ContactLayout& contact : contacts)
      if (const GlobalOrdinal place = number - contact.firstRow; 0 <= place && place < contact.numRows()) {
        const scene::SurfaceContact& terms = scene.contacts[contact.number];
        const std::size_t row = place;
        bound += terms.frictionBound * contact.portion(row) * contact.areas[row];
        coefficient += terms.friction * contact.portion(row);
      }
  }
  data.setFrictionBounds(problem, bounds);
  data.setFrictionCoefficients(problem, coefficients);
}

} // namespace epafi::model
