#include "epafi/model/ScenePlaces.hpp"

#include "epafi/contact/ContactPlaces.hpp"

#include <Tpetra_Map.hpp>

#include <optional>
#include <string>

namespace epafi::model {
namespace {

mesh::Surface joined(const mesh::Mesh& mesh, const std::vector<std::string>& names) {
  mesh::Surface all = mesh.surface(names.at(0));
  for (std::size_t k = 1; k < names.size(); ++k) {
    const mesh::Surface next = mesh.surface(names[k]);
    all.facetNodes.insert(all.facetNodes.end(), next.facetNodes.begin(), next.facetNodes.end());
    all.elements.insert(all.elements.end(), next.elements.begin(), next.elements.end());
  }
  return all;
}

/// One side of a contact.
struct Smooth {
  contact::NodePoints pointAt;
  contact::SmoothSurface surface;

  Smooth(const BodyLayout& body, const std::vector<std::string>& names)
      : pointAt([mesh = body.mesh.get()](GlobalOrdinal node) { return mesh->point(node); }),
        surface(pointAt, joined(*body.mesh, names)) {}
  [[nodiscard]] contact::SmoothSide side() const { return {&surface, &pointAt}; }
};

} // namespace

std::vector<decomposition::ContactPlace>
contactPlaces(const std::vector<BodyLayout>& bodies, const std::vector<contact::ContactLayout>& contacts,
              const std::vector<std::unique_ptr<fem::BodyModel>>& models, const Map& rows) {
  std::vector<decomposition::ContactPlace> places;
  const auto floats = [&](int body) { return body >= 0 && models[body]->kernelDimension() > 0; };
  for (const contact::ContactLayout& contact : contacts) {
    // Normals of obstacles are exact, and membranes have none.
    if (models.front()->components() == 1 || contact.secondBody < 0 ||
        !(floats(contact.firstBody) || floats(contact.secondBody)))
      continue;
    std::optional<Smooth> first, second; // once a row asks for them
    for (std::size_t row = 0; row < contact.firstNodes.size(); ++row) {
      if (!rows.isNodeGlobalElement(contact.firstRow + row))
        continue;
      if (!first) {
        first.emplace(bodies[contact.firstBody], contact.firstSurfaces);
        second.emplace(bodies[contact.secondBody], contact.secondSurfaces);
      }
      places.push_back(placeOf(contact, row, first->side(), second->side()));
    }
  }
  return places;
}

} // namespace epafi::model
