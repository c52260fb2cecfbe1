#include "epafi/accuracy/ContactTransfer.hpp"

#include "epafi/base/Collective.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#define BOOST_ALLOW_DEPRECATED_HEADERS // what its own headers include
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace epafi::accuracy {
namespace {

using contact::ContactLayout;
using model::Decomposition;
using TreePoint = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using Entry = std::pair<TreePoint, std::size_t>;
using Tree = boost::geometry::index::rtree<Entry, boost::geometry::index::quadratic<16>>;

/// Where the rows of a contact are.
std::vector<TreePoint> placesOf(const Decomposition& decomposition, const ContactLayout& contact) {
  const fem::Mesh& mesh = *decomposition.bodies[static_cast<std::size_t>(contact.firstBody)].mesh;
  std::vector<TreePoint> places;
  for (const GlobalOrdinal node : contact.firstNodes) {
    const fem::Point point = mesh.point(node);
    places.emplace_back(point[0], point[1], point[2]);
  }
  return places;
}

/// λ/area of all rows of a contact, on every rank. Collective.
std::vector<double> pressures(const Decomposition& decomposition, const ContactLayout& contact,
                              const Vector& lambda) {
  const Map& map = *lambda.getMap();
  const auto values = lambda.getData();
  std::vector<double> result(contact.firstNodes.size(), 0.0);
  for (std::size_t row = 0; row < result.size(); ++row) {
    const LocalOrdinal local = map.getLocalElement(contact.firstRow + static_cast<GlobalOrdinal>(row));
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
    std::vector<Entry> entries;
    for (const TreePoint& place : placesOf(from, coarse))
      entries.emplace_back(place, entries.size());
    if (entries.empty())
      continue;
    const Tree tree(entries);
    const std::vector<TreePoint> places = placesOf(to, fine);
    for (std::size_t row = 0; row < places.size(); ++row) {
      const LocalOrdinal local = map.getLocalElement(fine.firstRow + static_cast<GlobalOrdinal>(row));
      if (local < 0)
        continue;
      std::vector<Entry> nearest;
      tree.query(boost::geometry::index::nearest(places[row], 1), std::back_inserter(nearest));
      values[local] = std::max(0.0, pressure[nearest.front().second]) * fine.areas[row];
    }
  }
}

} // namespace epafi::accuracy
