#include "epafi/accuracy/ContactTransfer.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace epafi::accuracy {
namespace {

using contact::ContactLayout;
using model::Decomposition;

/// Where the rows of a contact are.
std::vector<Point> placesOf(const Decomposition& decomposition, const ContactLayout& contact) {
  const mesh::Mesh& mesh = *decomposition.bodies[contact.firstBody].mesh;
  std::vector<Point> places;
  for (const GlobalOrdinal node : contact.firstNodes)
    places.push_back(mesh.point(node));
  return places;
}

/// λ/area of all rows of a contact, on every rank. Collective.
std::vector<double> pressures(const Decomposition& decomposition, const ContactLayout& contact,
                              const Vector& lambda) {
  const Map& map = *lambda.getMap();
  const auto values = lambda.getData();
  std::vector<double> result(contact.firstNodes.size(), 0.0);
  for (std::size_t row = 0; row < result.size(); ++row) {
    const LocalOrdinal local = map.getLocalElement(contact.firstRow + row);
    if (local >= 0 && contact.areas[row] > 0)
      result[row] = values[local] / contact.areas[row];
  }
  sumOverRanks(*decomposition.problem.comm, std::span(result)); // each row is one rank's
  return result;
}

} // namespace

void transferContact(const Decomposition& from, const Vector& lambda, const Decomposition& to,
                     Vector& start) {
  const Map& map = *start.getMap();
  const auto values = start.getDataNonConst();
  for (std::size_t c = 0; c < to.contacts.size(); ++c) {
    const ContactLayout &coarse = from.contacts[c], &fine = to.contacts[c];
    const std::vector<double> pressure = pressures(from, coarse, lambda);
    if (pressure.empty())
      continue;
    const std::vector<Point> sources = placesOf(from, coarse), places = placesOf(to, fine);
    const mesh::BoxTree tree(sources);
    std::vector<std::size_t> near;
    for (std::size_t row = 0; row < places.size(); ++row) {
      const LocalOrdinal local = map.getLocalElement(fine.firstRow + row);
      if (local < 0 || fine.portion(row) == 0)
        continue;
      tree.nearest(places[row], 4, near); // of equally near ones, as in the middle of a facet, the first
      const double nearest = pressure[*std::ranges::min_element(near, {}, [&](std::size_t i) {
        return mesh::diameterOf(std::array{sources[i], places[row]});
      })];
      values[local] = std::max(0.0, nearest) * fine.areas[row];
    }
  }
}

} // namespace epafi::accuracy
