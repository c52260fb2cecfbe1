#include "epafi/deck/MeshCards.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/SortUnique.hpp"

#include <algorithm>

namespace epafi::deck {
namespace {

/// "S3" is 3.
int faceNumber(const Fields& fields, int field) {
  const std::string label = fields.name(field, "a face, S1 ... S6");
  if (label.size() != 2 || label[0] != 'S' || label[1] < '1' || label[1] > '6')
    fields.refuse(std::string("\"") + shortened(label) + "\" should be a face, S1 ... S6");
  return label[1] - '0';
}

void addFaces(Reading& reading, const Fields& fields, Surface& surface) {
  fields.requireAtMost(2);
  const int face = faceNumber(fields, 1);
  for (const GlobalOrdinal element : reading.elementsIn(fields, 0)) {
    const Elements& type = *reading.typeOf(element);
    if (face > findElementType(type.type)->numFaces)
      fields.refuse("element " + std::to_string(element) + " of type " + type.type + " has no face S" +
                    std::to_string(face));
    surface.faces.emplace_back(element, face);
  }
}

} // namespace

void readSurface(Reading& reading, const Card& card) {
  const std::string name = card.required("NAME");
  const std::string type = card.value("TYPE");
  if (!type.empty() && type != "NODE" && type != "ELEMENT")
    card.refuse("TYPE=" + shortened(type) + " is not read; a surface is of TYPE=ELEMENT or TYPE=NODE");
  Surface& surface = defined(card, name, reading.deck.surfaces);
  surface.ofNodes = type == "NODE";
  for (const Line& line : card.data) {
    const Fields fields(card, line);
    if (!surface.ofNodes) {
      addFaces(reading, fields, surface);
      continue;
    }
    fields.requireAtMost(2); // the second is an area, of no use here
    const std::vector<GlobalOrdinal> nodes = reading.nodes(fields, 0);
    surface.nodes.insert(surface.nodes.end(), nodes.begin(), nodes.end());
  }
  sortUnique(surface.nodes);
  sortUnique(surface.faces);
  if (surface.nodes.empty() && surface.faces.empty())
    card.refuse("\"" + shortened(name) + "\" is empty; name faces or nodes in the lines behind it");
}

} // namespace epafi::deck
