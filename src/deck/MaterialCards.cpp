#include "epafi/deck/MaterialCards.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::deck {
namespace {

Material& currentMaterial(Reading& reading, const Card& card) {
  if (reading.material == nullptr)
    card.refuse("it belongs behind a *MATERIAL");
  return *reading.material;
}

void requireOnce(const Card& card, bool isThere) {
  if (isThere)
    card.refuse("the material has it already; leave one of the two out");
}

/// \param Row  a row's temperature, which is its last value, and the values before it
template <class Row>
std::vector<Row> temperatureRows(const Card& card, int numConstants) {
  std::vector<Row> rows;
  for (const std::vector<double>& values : rowsOf(card, numConstants + 1, 1)) {
    rows.push_back({values.back(), {values.begin(), values.end() - 1}});
    if (rows.size() > 1 && rows.back().temperature <= rows[rows.size() - 2].temperature)
      card.refuse("the temperatures of its rows should ascend, and do not in row " +
                  std::to_string(rows.size()));
  }
  return rows;
}

/// D1111 D1122 D2222 D1133 D2233 D3333 D1212 D1313 D2323 of E1 E2 E3 ν12 ν13 ν23 G12 G13 G23.
std::vector<double> ofEngineeringConstants(const Card& card, const std::vector<double>& constants) {
  const double e1 = constants[0], e2 = constants[1], e3 = constants[2];
  const double v12 = constants[3], v13 = constants[4], v23 = constants[5];
  if (!(e1 > 0 && e2 > 0 && e3 > 0))
    card.refuse("the moduli E1, E2 and E3 should be positive");
  const double v21 = v12 * e2 / e1, v31 = v13 * e3 / e1, v32 = v23 * e3 / e2;
  const double determinant = 1 - v12 * v21 - v23 * v32 - v31 * v13 - 2 * v21 * v32 * v13;
  if (!(determinant > 0))
    card.refuse(
        "no elastic material has these Poisson's ratios: 1 - v12 v21 - v23 v32 - v31 v13 - 2 v21 v32 v13 "
        "should be positive");
  return {e1 * (1 - v23 * v32) / determinant,
          e1 * (v21 + v31 * v23) / determinant,
          e2 * (1 - v13 * v31) / determinant,
          e1 * (v31 + v21 * v32) / determinant,
          e2 * (v32 + v12 * v31) / determinant,
          e3 * (1 - v12 * v21) / determinant,
          constants[6],
          constants[7],
          constants[8]};
}

} // namespace

void readMaterial(Reading& reading, const Card& card) {
  reading.material = &defined(card, card.required("NAME"), reading.deck.materials);
}

void readElastic(Reading& reading, const Card& card) {
  using Kind = ElasticConstants::Kind;
  Material& material = currentMaterial(reading, card);
  requireOnce(card, material.elastic.has_value());
  const std::string type = card.value("TYPE");
  ElasticConstants elastic;
  const bool isEngineering = type.starts_with("ENGINEERING");
  int numConstants = 2;
  if (type.starts_with("ORTHO") || isEngineering) {
    elastic.kind = Kind::orthotropic;
    numConstants = 9;
  } else if (type.starts_with("ANISO")) {
    elastic.kind = Kind::anisotropic;
    numConstants = 21;
  } else if (!type.empty() && !type.starts_with("ISO"))
    card.refuse("TYPE=" + shortened(type) +
                " is not read; write it as ISO, ORTHO, ANISO or ENGINEERING CONSTANTS");
  elastic.rows = temperatureRows<ElasticConstants::Row>(card, numConstants);
  for (ElasticConstants::Row& row : elastic.rows) {
    if (isEngineering)
      row.constants = ofEngineeringConstants(card, row.constants);
    if (std::any_of(row.constants.begin(), row.constants.end(),
                    [](double value) { return !std::isfinite(value); }))
      card.refuse("its numbers are too large or too small to calculate with; measure in other units");
    if (elastic.kind == Kind::isotropic &&
        !(row.constants[0] > 0 && row.constants[1] > -1 && row.constants[1] < 0.5))
      card.refuse("Young's modulus should be positive and Poisson's ratio between -1 and 0.5");
  }
  material.elastic = std::move(elastic);
}

void readDensity(Reading& reading, const Card& card) {
  Material& material = currentMaterial(reading, card);
  requireOnce(card, material.density.has_value());
  const std::vector<std::vector<double>> rows = rowsOf(card, 2, 1);
  if (std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row[0] != rows[0][0]; }))
    card.refuse("it depends on temperature, and may not here; give one value");
  material.density = rows[0][0];
}

void readExpansion(Reading& reading, const Card& card) {
  Material& material = currentMaterial(reading, card);
  requireOnce(card, material.expansion.has_value());
  const std::string type = card.value("TYPE");
  if (!type.empty() && !type.starts_with("ISO") && !type.starts_with("ORTHO"))
    card.refuse("TYPE=" + shortened(type) + " is not read; write it as ISO or ORTHO");
  Expansion expansion;
  expansion.zero = card.number("ZERO").value_or(0);
  expansion.rows = temperatureRows<Expansion::Row>(card, type.starts_with("ORTHO") ? 3 : 1);
  material.expansion = std::move(expansion);
}

void readOrientation(Reading& reading, const Card& card) {
  const std::string name = card.required("NAME");
  const std::string system = card.value("SYSTEM"), definition = card.value("DEFINITION");
  if (!system.empty() && system != "RECTANGULAR" && system != "CYLINDRICAL")
    card.refuse("SYSTEM=" + shortened(system) + " is not read; write it as RECTANGULAR or CYLINDRICAL");
  if (!definition.empty() && definition != "COORDINATES")
    card.refuse("DEFINITION=" + shortened(definition) + " is not read; write it as COORDINATES");
  if (card.data.empty() || card.data.size() > 2)
    card.refuse("it needs a line with two points, and may have one with an axis and an angle");
  Orientation& orientation = defined(card, name, reading.deck.orientations);
  orientation.isCylindrical = system == "CYLINDRICAL";
  std::tie(orientation.a, orientation.b) = twoPoints(Fields(card, card.data[0]));
  if (card.data.size() == 1)
    return;
  const Fields turn(card, card.data[1]);
  turn.requireAtMost(2);
  orientation.rotationAxis = turn.integer(0, "a local axis, 1 ... 3");
  if (orientation.rotationAxis < 1 || orientation.rotationAxis > 3)
    turn.refuse("the axis is " + std::to_string(orientation.rotationAxis) + ", and should be 1, 2 or 3");
  orientation.rotationAngle = turn.realOr(1, "an angle in degrees", 0);
}

void readSolidSection(Reading& reading, const Card& card) {
  using To = Reading::Reference::To;
  Section section{card.place,
                  reading.elementSet(card, "ELSET"),
                  card.required("MATERIAL"),
                  card.value("ORIENTATION"),
                  {}};
  reading.refer(card, card.place, To::material, section.material);
  reading.refer(card, card.place, To::orientation, section.orientation);
  if (!card.data.empty()) {
    const Fields fields(card, card.data[0]);
    if (fields.has(0))
      section.thickness = fields.real(0, "a thickness");
    if (section.thickness.value_or(1) <= 0)
      fields.refuse("the thickness should be positive");
  }
  reading.deck.sections.push_back(std::move(section));
}

void readOtherSection(Reading& reading, const Card& card) {
  const auto set = reading.deck.elementSets.find(card.value("ELSET"));
  if (set != reading.deck.elementSets.end() && !set->second.empty())
    card.refuse("bodies are solids here, or of plane or axisymmetric elements; give them a *SOLID SECTION");
  reading.ignore(card.shown + " without elements", card.place);
}

} // namespace epafi::deck
