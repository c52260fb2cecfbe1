#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace epafi::deck {
namespace {

using Temperatures = std::map<GlobalOrdinal, double>;

/// What rows say at a temperature: linear between them, constant before and behind.
template <class Row>
std::vector<double> valuesAt(const std::vector<Row>& rows, std::vector<double> Row::*values,
                             double temperature) {
  const auto above =
      std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.temperature >= temperature; });
  if (above == rows.begin() || above == rows.end())
    return above == rows.end() ? rows.back().*values : rows.front().*values;
  const Row& below = *(above - 1);
  const double share = (temperature - below.temperature) / (above->temperature - below.temperature);
  std::vector<double> result(below.*values);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] += share * (((*above).*values)[i] - result[i]);
  return result;
}

/// Temperatures that nothing is said of are 0.
double temperatureOf(const Temperatures& temperatures, GlobalOrdinal node) {
  const auto found = temperatures.find(node);
  return found == temperatures.end() ? 0 : found->second;
}

/// By what the constants at a temperature are those of the first row.
double stiffnessAt(const Material& material, double temperature) {
  const std::vector<ElasticConstants::Row>& rows = material.elastic->rows;
  const double first = rows.front().constants.front();
  for (const ElasticConstants::Row& row : rows) {
    std::vector<double> expected = rows.front().constants;
    const bool isIsotropic = material.elastic->kind == ElasticConstants::Kind::isotropic;
    for (std::size_t i = 0; i < (isIsotropic ? 1 : expected.size()); ++i)
      expected[i] *= row.constants.front() / first;
    for (std::size_t i = 0; i < expected.size(); ++i)
      if (std::abs(row.constants[i] - expected[i]) > 1e-6 * std::abs(row.constants[i]))
        throw InputError(
            text(material.place) +
            ": *ELASTIC: constants that change by other than one factor, as with another Poisson's "
            "ratio, need one temperature of the whole body in all steps here; give those of one "
            "temperature");
  }
  return valuesAt(rows, &ElasticConstants::Row::constants, temperature).front() / first;
}

/// α that a material has in the scene: the first one that is not 0.
double referenceExpansion(const Material& material) {
  if (material.expansion)
    for (const Expansion::Row& row : material.expansion->rows) {
      const std::vector<double>& alpha = row.coefficients;
      if (std::any_of(alpha.begin(), alpha.end(), [&](double other) { return other != alpha.front(); }))
        throw InputError(text(material.place) +
                         ": *EXPANSION: materials that expand differently along their axes are not solved "
                         "here; give one coefficient, TYPE=ISO");
      if (alpha.front() != 0)
        return alpha.front();
    }
  return 0;
}

/// The change of temperature by which a material with the expansion α of the scene has the deck's strain,
/// α(T)(T − Z) − α(T0)(T0 − Z), Z its temperature without strain. Between nodes it is interpolated, which is
/// exact where α is constant or the temperature is.
double equivalentChange(const Expansion& expansion, double reference, double initial, double temperature) {
  if (expansion.rows.size() == 1)
    return temperature - initial;
  const auto strain = [&](double t) {
    return valuesAt(expansion.rows, &Expansion::Row::coefficients, t).front() * (t - expansion.zero);
  };
  return (strain(temperature) - strain(initial)) / reference;
}

} // namespace

ModelMaker::Temperatures ModelMaker::initialTemperatures() const {
  Temperatures result;
  for (const Temperature& initial : deck_.initialTemperatures)
    for (const GlobalOrdinal node : initial.nodes)
      result[node] = initial.value;
  return result;
}

ModelMaker::Temperatures ModelMaker::temperaturesAt(std::size_t step) const {
  std::map<GlobalOrdinal, const Temperature*> cards; // the last one of a node holds
  for (std::size_t k = 0; k <= step; ++k) {
    if (deck_.steps[k].newTemperatures)
      cards.clear();
    for (const Temperature& card : deck_.steps[k].temperatures)
      for (const GlobalOrdinal node : card.nodes)
        cards[node] = &card;
  }
  Temperatures result = initialTemperatures();
  for (const auto& [node, card] : cards)
    result[node] = card->value * factorAt(card->amplitude, card->delay, step);
  return result;
}

std::set<double> ModelMaker::temperaturesIn(int body) const {
  std::set<double> temperatures;
  for (std::size_t step = 0; step < deck_.steps.size(); ++step) {
    const Temperatures now = temperaturesAt(step);
    for (const GlobalOrdinal node : bodies_.all()[body].nodes)
      temperatures.insert(temperatureOf(now, node));
  }
  return temperatures;
}

std::vector<double> ModelMaker::constantsOf(const Material& material, int body) const {
  const auto& rows = material.elastic->rows;
  if (rows.size() == 1)
    return rows.front().constants;
  const std::set<double> temperatures = temperaturesIn(body);
  return temperatures.size() > 1 ? rows.front().constants
                                 : valuesAt(rows, &ElasticConstants::Row::constants, *temperatures.begin());
}

void ModelMaker::addStiffnessFactors(int body) {
  const std::vector<const Material*> materials = materialsOf(body);
  const auto varies = [](const Material* material) { return material->elastic->rows.size() > 1; };
  const auto first = std::find_if(materials.begin(), materials.end(), varies);
  if (first == materials.end() || temperaturesIn(body).size() == 1)
    return;
  const std::string place = text((*first)->place) + ": *ELASTIC: constants of several temperatures ";
  const Temperatures now = temperaturesAt(0);
  for (std::size_t step = 1; step < deck_.steps.size(); ++step) {
    const Temperatures then = temperaturesAt(step);
    for (const GlobalOrdinal node : bodies_.all()[body].nodes)
      if (temperatureOf(then, node) != temperatureOf(now, node))
        throw InputError(place +
                         "need the same temperatures in all steps here; make each step a deck of its own");
  }
  std::map<double, Numbers> groups; // nodes with the same factor
  for (const GlobalOrdinal node : bodies_.all()[body].nodes) {
    const double factor = stiffnessAt(**first, temperatureOf(now, node));
    for (const Material* material : materials)
      if (std::abs(stiffnessAt(*material, temperatureOf(now, node)) - factor) > 1e-12 * factor)
        throw InputError(place +
                         "that change in another way than those of another material of the body are not "
                         "solved here; tie bodies of one material each");
    groups[factor].push_back(node);
  }
  for (const auto& [factor, nodes] : groups) {
    Teuchos::ParameterList& list =
        listOf(body).sublist("Stiffness Factors").sublist("factor " + valueText(factor));
    list.set("Surface", nodesNamed("warm " + std::to_string(model_.groups.nodes.size() + 1), nodes));
    list.set("Value", factor);
  }
}

void ModelMaker::setExpansion(Teuchos::ParameterList& list, const Material& material) const {
  if (std::any_of(deck_.steps.begin(), deck_.steps.end(),
                  [](const Step& step) { return !step.temperatures.empty(); }))
    list.set("Expansion", referenceExpansion(material));
}

std::vector<const Material*> ModelMaker::materialsOf(int body) const {
  std::vector<const Material*> materials;
  for (const GlobalOrdinal element : bodies_.all()[body].elements) {
    const Material* material = &deck_.materials.at(deck_.sections[bodies_.sectionOf(element)].material);
    if (std::find(materials.begin(), materials.end(), material) == materials.end())
      materials.push_back(material);
  }
  return materials;
}

ModelMaker::Temperatures ModelMaker::changesOf(int body, const Temperatures& initial,
                                               const Temperatures& now) const {
  Temperatures changes;
  for (const Material* material : materialsOf(body)) {
    const double reference = referenceExpansion(*material);
    for (const GlobalOrdinal node : bodies_.all()[body].nodes) {
      if (reference == 0)
        break;
      const double change = equivalentChange(*material->expansion, reference, temperatureOf(initial, node),
                                             temperatureOf(now, node));
      const auto [other, isNew] = changes.try_emplace(node, change);
      if (!isNew && std::abs(other->second - change) > 1e-12 * std::abs(change))
        throw InputError(text(material->place) +
                         ": *EXPANSION: coefficients that change with the temperature, in another way than "
                         "those of another material of the body, are not solved here; tie bodies of one "
                         "material each, or give one coefficient a material");
    }
  }
  return changes;
}

void ModelMaker::addTemperatures(std::size_t step) {
  const Temperatures initial = initialTemperatures(), now = temperaturesAt(step);
  for (int b = 0; b < std::ssize(bodies_.all()) && now != initial; ++b) {
    std::map<double, Numbers> groups; // nodes with the same change
    for (const auto& [node, change] : changesOf(b, initial, now))
      if (change != 0)
        groups[change].push_back(node);
    for (const auto& [change, nodes] : groups) {
      Teuchos::ParameterList& load = addLoad(b, step, "temperature");
      if (nodes != bodies_.all()[b].nodes)
        load.set("Surface", nodesNamed("heated " + std::to_string(model_.groups.nodes.size() + 1), nodes));
      load.set("Value", change);
    }
  }
}

} // namespace epafi::deck
