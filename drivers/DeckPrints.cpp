#include "DeckPrints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/output/BodyFields.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

namespace epafi::drivers {
namespace {

std::string inColumns(std::span<const double> values, const char* format) {
  std::string text;
  std::array<char, 32> number{};
  for (const double value : values) {
    std::snprintf(number.data(), number.size(), format, value);
    text += number.data();
  }
  return text;
}

std::string printedRow(GlobalOrdinal node, std::span<const double> values) {
  const std::string number = std::to_string(node);
  return std::string(10 - std::min<std::size_t>(10, number.size()), ' ') + number +
         inColumns(values, " %13.6E") + '\n';
}

std::string printTitle(const std::string& what, const std::string& time) {
  return "\n " + what + " and time  " + time + "\n\n";
}

} // namespace

DeckPrints::DeckPrints(const std::string& scene) {
  if (!deck::isDeck(scene))
    return;
  deck_ = deck::readDeck(scene);
  nodeNumbers_ = modelOf(deck_, scene).nodeNumbers;
}

/// On rank 0 of all nodes. Collective.
DeckPrints::Values DeckPrints::valuesOf(const simulation::SolvedScene& solved) const {
  Values values;
  const std::size_t components = solved.decomposition.problem.components;
  for (int b = 0; b < std::ssize(solved.decomposition.bodies); ++b) {
    const std::vector<double> u = gatherOnFirst(solved.comm(), output::gatherBodyFields(solved, b).u);
    const std::vector<Vector3> forces =
        gatherOnFirst(solved.comm(), simulation::supportForcesAtNodes(solved, b));
    for (std::size_t k = 0; k < forces.size() && !nodeNumbers_.empty(); ++k) {
      NodeValues& node = values[nodeNumbers_[b].at(k)];
      std::copy_n(u.begin() + k * components, components, node.displacement.begin());
      for (std::size_t d = 0; d < 3; ++d)
        node.force[d] += forces[k][d];
    }
  }
  return values;
}

void DeckPrints::addNodes(const deck::Print& print, const Values& values, const std::string& time) {
  const auto addField = [&](const std::string& what, const char* sum,
                            std::array<double, 3> NodeValues::*field) {
    std::array<double, 3> total{};
    std::string rows;
    for (const GlobalOrdinal number : deck_.nodeSets.at(print.set))
      if (const auto node = values.find(number); node != values.end()) {
        rows += printedRow(number, node->second.*field);
        for (std::size_t d = 0; d < 3; ++d)
          total[d] += (node->second.*field)[d];
      }
    if (print.totals != deck::Print::Totals::alone || sum == nullptr)
      text_ += printTitle(what + " for set " + print.set, time) + rows;
    if (print.totals != deck::Print::Totals::none && sum != nullptr)
      text_ += printTitle(std::string(sum) + " for set " + print.set, time) + "  " +
               inColumns(total, " %13.6E") + '\n';
  };
  for (const std::string& field : print.fields)
    if (field == "U")
      addField("displacements (vx,vy,vz)", nullptr, &NodeValues::displacement);
    else
      addField("forces (fx,fy,fz)", "total force (fx,fy,fz)", &NodeValues::force);
}

/// Bodies that have faces of both surfaces count together.
void DeckPrints::addContacts(const deck::Print& print, const simulation::RunResult& result,
                             const std::string& time) {
  for (const deck::ContactPair& pair : deck_.contacts) {
    if (print.fields.empty() || (!print.dependent.empty() && print.dependent != pair.dependent) ||
        (!print.independent.empty() && print.independent != pair.independent))
      continue;
    const std::string name = pair.dependent + " - " + pair.independent;
    std::array<double, 3> total{};
    const auto add = [&](const auto& joints) {
      for (const auto& joint : joints)
        if (joint.name == name || joint.name.starts_with(name + ' '))
          for (std::size_t d = 0; d < 3; ++d)
            total[d] += joint.resultant[d];
    };
    add(result.contacts);
    add(result.ties);
    text_ +=
        printTitle("statistics for slave set " + pair.dependent + ", master set " + pair.independent, time) +
        "   total surface force (fx,fy,fz)\n\n  " + inColumns(total, " %13.6E") + '\n';
  }
}

void DeckPrints::add(simulation::SceneRun& run, std::size_t step) {
  const Values values = valuesOf(run.solved());
  if (deck_.steps.empty())
    return;
  double time = 0;
  for (std::size_t k = 0; k <= step; ++k)
    time += deck_.steps.at(k).period;
  const std::string shown = inColumns(std::array{time}, "%.7E");
  for (const bool areOfNodes : {true, false}) {
    const auto isOfKind = [&](const deck::Print& print) { return print.set.empty() != areOfNodes; };
    const auto hasNone = [&](const std::vector<deck::Print>& prints) {
      return std::none_of(prints.begin(), prints.end(), isOfKind);
    };
    std::size_t last = step;
    while (last > 0 && hasNone(deck_.steps[last].prints))
      --last;
    for (const deck::Print& print : deck_.steps[last].prints)
      if (isOfKind(print))
        areOfNodes ? addNodes(print, values, shown) : addContacts(print, run.result, shown);
  }
}

} // namespace epafi::drivers
