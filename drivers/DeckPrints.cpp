#include "DeckPrints.hpp"

#include "PrintText.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/deck/DeckSections.hpp"
#include "epafi/output/BodyFields.hpp"

#include <algorithm>
#include <array>

namespace epafi::drivers {

using deck::Print;

DeckPrints::DeckPrints(const std::string& scene, const std::vector<simulation::NodeSlip>& slip)
    : slip_(slip) {
  if (!deck::isDeck(scene))
    return;
  deck_ = deck::readDeck(scene);
  deck::DeckModel model = modelOf(deck_, scene);
  nodeNumbers_ = std::move(model.nodeNumbers);
  elementNumbers_ = std::move(model.elementNumbers);
}

/// Those of a kind hold until a step has others of it.
std::vector<Print> DeckPrints::printsOf(std::size_t step) const {
  std::vector<Print> result;
  for (const Print::Of kind :
       {Print::Of::nodes, Print::Of::elements, Print::Of::contact, Print::Of::section}) {
    const auto isOfKind = [&](const Print& print) { return print.of == kind; };
    for (std::size_t k = step + 1; k-- > 0;) {
      const std::vector<Print>& prints = deck_.steps[k].prints;
      std::copy_if(prints.begin(), prints.end(), std::back_inserter(result), isOfKind);
      if (std::any_of(prints.begin(), prints.end(), isOfKind))
        break;
    }
  }
  return result;
}

/// On rank 0 of all nodes. Collective.
DeckPrints::Nodes DeckPrints::nodesOf(const simulation::SolvedScene& solved) const {
  Nodes nodes;
  const std::size_t components = solved.decomposition.problem.components;
  for (int b = 0; b < std::ssize(solved.decomposition.bodies); ++b) {
    const std::vector<double> u = gatherOnFirst(solved.comm(), output::gatherBodyFields(solved, b).u);
    const std::vector<Vector3> forces =
        gatherOnFirst(solved.comm(), simulation::supportForcesAtNodes(solved, b));
    for (std::size_t k = 0; k < forces.size() && !nodeNumbers_.empty(); ++k) {
      NodeValues& node = nodes[nodeNumbers_[b].at(k)];
      std::copy_n(u.begin() + k * components, components, node.displacement.begin());
      for (std::size_t d = 0; d < 3; ++d)
        node.force[d] += forces[k][d];
    }
  }
  return nodes;
}

/// On rank 0 of all elements of solids. Collective.
DeckPrints::Points DeckPrints::pointsOf(const simulation::SolvedScene& solved) const {
  std::vector<int> isReduced; // as the deck has it: elements that stand alone are integrated fully
  collectively(solved.comm(), [&] {
    if (nodeNumbers_.empty())
      return;
    const deck::DeckBodies bodies(deck_);
    for (const deck::DeckBody& body : bodies.all())
      isReduced.push_back(body.type->isReduced ? 1 : 0);
  });
  isReduced = gatherOnAll(solved.comm(), isReduced);
  Points points;
  for (int b = 0; b < std::ssize(isReduced); ++b)
    for (const output::ElementPoint& point : output::gatherElementPoints(
             solved, b, isReduced[b] != 0 ? fem::Integration::reduced : fem::Integration::full))
      points[elementNumbers_[b].at(point.element)].push_back(point.state);
  return points;
}

/// On rank 0 of all rows. Collective.
DeckPrints::Contacts DeckPrints::contactsOf(const simulation::SceneRun& run) {
  const simulation::SolvedScene solved = run.solved();
  Contacts contacts;
  for (int c = 0; c < std::ssize(run.decomposition->contacts); ++c) {
    std::vector<output::ContactValues> values =
        output::gatherContactValues(solved, c, run.evaluation.contacts[c]);
    slip_.enter(solved, c, values);
    const contact::ContactLayout& layout = run.decomposition->contacts[c];
    const std::vector<std::size_t> rows = layout.ownRows();
    contacts.emplace_back();
    for (std::size_t k = 0; k < values.size() && !nodeNumbers_.empty(); ++k)
      contacts.back()[nodeNumbers_[layout.firstBody].at(layout.firstNodes[rows[k]])] = values[k];
  }
  return contacts;
}

/// On all ranks. Collective.
std::vector<simulation::SectionForce> DeckPrints::sectionsOf(const simulation::SolvedScene& solved,
                                                             const std::vector<Print>& prints) const {
  std::vector<std::vector<simulation::SectionShare>> shares;
  collectively(solved.comm(), [&] {
    const auto placeIn = [](const std::vector<GlobalOrdinal>& numbers, GlobalOrdinal number) {
      return std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin();
    };
    if (nodeNumbers_.empty())
      return;
    const deck::DeckBodies bodies(deck_);
    for (const Print& print : prints) {
      if (print.of != Print::Of::section)
        continue;
      shares.emplace_back();
      if (const auto section = sectionAt(deck_, bodies, deck_.surfaces.at(print.set)))
        for (const auto& [element, node] : section->nodesOfElements) {
          const int body = bodies.ofElement(element);
          shares.back().push_back(
              {body, placeIn(bodies.all()[body].elements, element), placeIn(bodies.all()[body].nodes, node)});
        }
    }
  });
  const int numSections = maxOverRanks(solved.comm(), static_cast<int>(shares.size()));
  shares.resize(numSections);
  std::vector<simulation::SectionForce> forces;
  for (const std::vector<simulation::SectionShare>& own : shares)
    forces.push_back(simulation::sectionForce(solved, gatherOnAll(solved.comm(), own)));
  return forces;
}

/// Collective.
DeckPrints::Values DeckPrints::valuesOf(simulation::SceneRun& run, const std::vector<Print>& prints) {
  const simulation::SolvedScene solved = run.solved();
  const auto isAskedFor = [&](Print::Of kind) {
    bool own = std::any_of(prints.begin(), prints.end(), [&](const Print& p) { return p.of == kind; });
    for (const deck::Step& step : deck_.steps) // what slips is counted from the first one on
      for (const Print& print : step.prints)
        own = own || (kind == Print::Of::contact && print.of == kind);
    return maxOverRanks(solved.comm(), own ? 1 : 0) > 0;
  };
  Values values;
  const bool areSolids = run.scene.bodies.front().physics == fem::Physics::elasticity3d;
  if (isAskedFor(Print::Of::nodes))
    values.nodes = nodesOf(solved);
  if (isAskedFor(Print::Of::elements) && areSolids)
    values.points = pointsOf(solved);
  if (isAskedFor(Print::Of::contact))
    values.contacts = contactsOf(run);
  if (isAskedFor(Print::Of::section))
    values.sections = sectionsOf(solved, prints);
  return values;
}

void DeckPrints::addNodes(const Print& print, const Values& values) {
  const auto addField = [&](const std::string& what, const char* sum,
                            std::array<double, 3> NodeValues::*field) {
    std::array<double, 3> total{};
    std::string rows;
    for (const GlobalOrdinal number : deck_.nodeSets.at(print.set))
      if (const auto node = values.nodes.find(number); node != values.nodes.end()) {
        rows += printedRow(number, node->second.*field);
        for (std::size_t d = 0; d < 3; ++d)
          total[d] += (node->second.*field)[d];
      }
    if (print.totals != Print::Totals::alone || sum == nullptr)
      text_ += printTitle(what + " for set " + print.set, values.time) + rows;
    if (print.totals != Print::Totals::none && sum != nullptr)
      text_ += printTitle(std::string(sum) + " for set " + print.set, values.time) + "  " + inColumns(total) +
               '\n';
  };
  for (const std::string& field : print.fields)
    if (field == "U")
      addField("displacements (vx,vy,vz)", nullptr, &NodeValues::displacement);
    else
      addField("forces (fx,fy,fz)", "total force (fx,fy,fz)", &NodeValues::force);
}

void DeckPrints::add(simulation::SceneRun& run, std::size_t step) {
  const std::vector<Print> prints = deck_.steps.empty() ? std::vector<Print>() : printsOf(step);
  Values values = valuesOf(run, prints);
  double time = 0;
  for (std::size_t k = 0; k <= step && k < deck_.steps.size(); ++k)
    time += deck_.steps[k].period;
  values.time = inColumns(std::array{time}, "%.7E");
  std::size_t numSections = 0;
  for (const Print& print : prints) {
    if (print.of == Print::Of::nodes)
      addNodes(print, values);
    else if (print.of == Print::Of::elements)
      addElements(print, values);
    else if (print.of == Print::Of::contact)
      addContacts(print, run, values);
    else
      addSection(print, values.sections.at(numSections++), values.time);
  }
}

} // namespace epafi::drivers
