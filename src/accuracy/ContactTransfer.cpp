#include "epafi/accuracy/ContactTransfer.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <utility>
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

/// What acts at a row.
struct Traction {
  double pressure = 0; ///< λ/area
  /// The direction of friction in space, as long as the share of its bound that it takes.
  Eigen::Vector3d friction = Eigen::Vector3d::Zero();
};

/// action(row of the contact, node) for this rank's rows that have friction. Not collective.
template <class Action>
void forEachFrictionNode(const Decomposition& decomposition, const ContactLayout& contact,
                         const Action& action) {
  if (contact.firstFriction < 0)
    return;
  for (const decomposition::FrictionNode& node : decomposition.problem.frictionNodes)
    if (const GlobalOrdinal row = decomposition.problem.numberOf(node.contact) - contact.firstRow;
        0 <= row && row < contact.numRows())
      action(static_cast<std::size_t>(row), node);
}

/// What acts at all rows of a contact, on every rank. Collective.
std::vector<Traction> tractions(const Decomposition& decomposition, const ContactLayout& contact,
                                const Vector& lambda) {
  constexpr std::size_t perRow = 4;
  const Map& map = *lambda.getMap();
  const auto values = lambda.getData();
  std::vector<double> sums(perRow * contact.firstNodes.size(), 0.0); // each row is one rank's
  for (std::size_t row = 0; row < contact.firstNodes.size(); ++row) {
    const LocalOrdinal local = map.getLocalElement(contact.firstRow + row);
    if (local >= 0 && contact.areas[row] > 0)
      sums[perRow * row] = values[local] / contact.areas[row];
  }
  const contact::ContactTangents tangents(contact);
  forEachFrictionNode(decomposition, contact, [&](std::size_t row, const decomposition::FrictionNode& node) {
    const double bound = decomposition.data.frictionBound(node, values[node.contact]);
    for (int k = 0; k < decomposition.problem.components - 1 && bound > 0; ++k)
      for (std::size_t d = 0; d < 3; ++d)
        sums[perRow * row + 1 + d] += values[node.firstTangent + k] / bound * tangents.at(row)[k][d];
  });
  sumOverRanks(*decomposition.problem.comm, std::span(sums));
  std::vector<Traction> result;
  for (std::size_t first = 0; first < sums.size(); first += perRow)
    result.push_back({sums[first], {sums[first + 1], sums[first + 2], sums[first + 3]}});
  return result;
}

/// The row of each place that is nearest among those of `sources`; of equally near ones, as in the middle of
/// a facet, the first.
class NearestRow {
public:
  explicit NearestRow(std::vector<Point> sources) : sources_(std::move(sources)), tree_(sources_) {}
  [[nodiscard]] std::size_t of(const Point& place) {
    tree_.nearest(place, 4, near_);
    return *std::ranges::min_element(near_, {}, [&](std::size_t i) {
      return mesh::diameterOf(std::array{sources_[i], place});
    });
  }

private:
  std::vector<Point> sources_;
  mesh::BoxTree tree_;
  std::vector<std::size_t> near_;
};

} // namespace

void transferContact(const Decomposition& from, const Vector& lambda, const Decomposition& to,
                     Vector& start) {
  constexpr double nearlyAll = 0.99;   // of its bound: as far as the coarser iteration went it slipped
  constexpr double outside = 1 + 1e-9; // and is projected onto its bound
  constexpr double least = 1e-300;
  const Map& map = *start.getMap();
  const auto values = start.getDataNonConst();
  for (std::size_t c = 0; c < to.contacts.size(); ++c) {
    const ContactLayout &coarse = from.contacts[c], &fine = to.contacts[c];
    const std::vector<Traction> known = tractions(from, coarse, lambda);
    if (known.empty())
      continue;
    const std::vector<Point> places = placesOf(to, fine);
    NearestRow nearest(placesOf(from, coarse));
    for (std::size_t row = 0; row < places.size(); ++row)
      if (const LocalOrdinal local = map.getLocalElement(fine.firstRow + row);
          local >= 0 && fine.portion(row) > 0)
        values[local] = std::max(0.0, known[nearest.of(places[row])].pressure) * fine.areas[row];
    const double side = coarse.firstBody == fine.firstBody ? 1 : -1; // whose body has the rows
    const contact::ContactTangents tangents(fine);
    forEachFrictionNode(to, fine, [&](std::size_t row, const decomposition::FrictionNode& node) {
      const Eigen::Vector3d& friction = known[nearest.of(places[row])].friction;
      Eigen::Vector2d along(friction.dot(tangents.at(row)[0]),
                            to.problem.components > 2 ? friction.dot(tangents.at(row)[1]) : 0.0);
      const double share = friction.norm() > nearlyAll ? outside : friction.norm();
      along *= side * share / std::max(along.norm(), least);
      for (int k = 0; k < to.problem.components - 1; ++k)
        values[node.firstTangent + k] = to.data.frictionBound(node, values[node.contact]) * along[k];
    });
  }
}

} // namespace epafi::accuracy
