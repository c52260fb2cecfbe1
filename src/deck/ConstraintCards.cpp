#include "epafi/deck/ConditionCards.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>

namespace epafi::deck {
namespace {

constexpr int valuesPerTerm = 3;

/// Terms of a line: node, component, factor, and again.
void addTerms(Reading& reading, const Fields& fields, GlobalOrdinal numTerms, Equation& equation) {
  if (fields.size() % valuesPerTerm != 0)
    fields.refuse("it has " + std::to_string(fields.size()) +
                  " values, and a term has three: a node, a component and a factor");
  for (int i = 0; i < fields.size(); i += valuesPerTerm) {
    if (std::ssize(equation.terms) == numTerms)
      fields.refuse("the equation has more than the " + std::to_string(numTerms) + " terms that it says");
    const int component = fields.integer(i + 1, "a component, 1 ... 3");
    if (component < 1 || component > 3)
      fields.refuse("a term is of component " + std::to_string(component) +
                    ", and displacements have those of "
                    "1 ... 3");
    equation.terms.push_back({reading.node(fields, i), component, fields.real(i + 2, "a factor")});
  }
}

} // namespace

void readEquation(Reading& reading, const Card& card) {
  GlobalOrdinal numTerms = 0;
  bool isComplete = true;
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    std::vector<Equation>& equations = reading.deck.equations;
    if (isComplete) {
      fields.requireAtMost(1);
      numTerms = fields.number(0, "terms");
      equations.push_back({line.place(), {}});
    } else
      addTerms(reading, fields, numTerms, equations.back());
    isComplete = std::ssize(equations.back().terms) == numTerms;
    const auto& terms = equations.back().terms;
    if (isComplete &&
        std::none_of(terms.begin(), terms.end(), [](const Equation::Term& term) { return term.factor != 0; }))
      fields.refuse("all factors of the equation are 0");
  }
  if (!isComplete)
    card.refuse("the last equation has fewer than the " + std::to_string(numTerms) + " terms that it says");
}

void readTransform(Reading& reading, const Card& card) {
  const std::string type = card.value("TYPE");
  if (!type.empty() && type != "R" && type != "C")
    card.refuse("TYPE=" + shortened(type) + " is not read; write R (rectangular) or C (cylindrical)");
  if (card.data.size() != 1)
    card.refuse("behind it belongs one line with two points");
  const std::string set = reading.nodeSet(card, "NSET");
  reading.count(card, reading.deck.nodeSets[set].size());
  Transform transform{card.place, reading.deck.nodeSets[set], type == "C", {}, {}};
  std::tie(transform.a, transform.b) = twoPoints(Fields(card, card.data[0]));
  reading.deck.transforms.push_back(std::move(transform));
}

void readAmplitude(Reading& reading, const Card& card) {
  const std::string name = card.required("NAME"), definition = card.value("DEFINITION");
  if (!definition.empty() && definition != "TABULAR")
    card.refuse("DEFINITION=" + shortened(definition) +
                " is not read; write it as a table of times and factors");
  Amplitude& amplitude = defined(card, name, reading.deck.amplitudes);
  amplitude.isOfTotalTime = card.value("TIME") == "TOTALTIME";
  const double time0 = card.number("SHIFTX").value_or(0), factor0 = card.number("SHIFTY").value_or(0);
  if (card.has("USER")) {
    if (!name.starts_with("QUADRATIC"))
      card.refuse(
          "USER calls a subroutine, which there is none of here; write it as a table of times and factors");
    amplitude.isSquareOfTime = true;
    return;
  }
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    for (int i = 0; i < fields.size(); i += 2) {
      amplitude.points.emplace_back(fields.real(i, "a time") + time0,
                                    fields.real(i + 1, "a factor") + factor0);
      const auto& points = amplitude.points;
      if (points.size() > 1 && points.back().first < points[points.size() - 2].first)
        fields.refuse("times should ascend, and " + std::string(fields[i]) + " comes after a later one");
    }
  }
  if (amplitude.points.empty())
    card.refuse("it has no points; write times and factors in the lines behind it");
}

} // namespace epafi::deck
