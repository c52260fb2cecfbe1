#include "epafi/assembly/FacetSearch.hpp"

#include "epafi/assembly/SearchedFacets.hpp"
#include "epafi/base/ArrayIndex.hpp"
#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

namespace epafi::assembly {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double nowhere = std::numeric_limits<double>::infinity();

/// A face with its facets in a tree.
struct SearchedFace {
  std::vector<Facet> facets;
  std::unique_ptr<mesh::BoxTree> tree;
  std::array<Point, 2> box;
};

SearchedFace searchedFace(const MeshedBody& body, const mesh::Surface& surface) {
  SearchedFace face;
  std::vector<std::array<Point, 2>> boxes;
  std::vector<Point> all;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    Facet& facet = face.facets.emplace_back();
    facet.type = surface.typeOf(f);
    std::vector<Point> points;
    for (const GlobalOrdinal node : surface.facet(f)) {
      points.push_back(body.mesh->point(node));
      if (index(node) < body.nodeNumbers.size())
        facet.nodes.push_back(body.nodeNumbers[index(node)]);
    }
    facet.points.resize(3, std::ssize(points));
    for (std::size_t a = 0; a < points.size(); ++a)
      facet.points.col(index(a)) = Vector3d(points[a][0], points[a][1], points[a][2]);
    constexpr double bulge = 0.05; // beyond the nodes
    facet.box = mesh::boxOf(points, bulge * mesh::diameterOf(points));
    boxes.push_back(facet.box);
    all.insert(all.end(), facet.box.begin(), facet.box.end());
  }
  setSags(surface, face.facets);
  face.tree = std::make_unique<mesh::BoxTree>(std::span<const mesh::BoxTree::Box>(boxes));
  face.box = mesh::boxOf(all);
  return face;
}

bool areNear(const std::array<Point, 2>& a, const std::array<Point, 2>& b, double distance) {
  for (std::size_t d = 0; d < 3; ++d)
    if (a[0][d] > b[1][d] + distance || b[0][d] > a[1][d] + distance)
      return false;
  return true;
}

bool shareNodes(const Facet& a, const Facet& b) {
  return std::any_of(a.nodes.begin(), a.nodes.end(), [&](GlobalOrdinal node) {
    return std::find(b.nodes.begin(), b.nodes.end(), node) != b.nodes.end();
  });
}

/// What lies opposite to a point.
struct Opposite {
  double gap = nowhere; ///< negative where bodies overlap
  double sag = 0;       ///< of both facets
};

class FacetPairs {
public:
  FacetPairs(std::span<const MeshedBody> bodies, const PairSearch& search, MeshFaces& faces)
      : bodies_(bodies), faces_(faces), distance_(search.distanceIn(faces.assembly)),
        opposed_(-std::cos(search.angle * std::numbers::pi / 180)), searched_(faces.faces.size()) {}

  void look(int a, int b);

private:
  /// The nearest place of all samples; where many are, one at which facets are least off.
  struct Nearest {
    const SearchedFace* to = nullptr;
    const Facet* facet = nullptr;
    Vector2d xi{0, 0};
    Opposite opposite;
  };

  [[nodiscard]] double reach() const { return nearMissFactor * distance_; }
  const SearchedFace& searched(int face);
  [[nodiscard]] Opposite oppositeOf(const FacetPoint& point, const Facet& facet,
                                    const SearchedFace& other) const;
  /// Takes in what one face's samples see of the other.
  void sample(const SearchedFace& from, const SearchedFace& to, FacePair& pair, bool countsArea,
              Nearest& nearest) const;
  void descend(Nearest& nearest) const;

  std::span<const MeshedBody> bodies_;
  MeshFaces& faces_;
  double distance_, opposed_;
  std::vector<std::optional<SearchedFace>> searched_;
};

const SearchedFace& FacetPairs::searched(int face) {
  auto& own = searched_[index(face)];
  if (!own)
    own = searchedFace(bodies_[index(faces_.faces[index(face)].body)], faces_.faces[index(face)].surface);
  return *own;
}

Opposite FacetPairs::oppositeOf(const FacetPoint& point, const Facet& facet,
                                const SearchedFace& other) const {
  const Vector3d ends[] = {point.place - reach() * point.normal, point.place + reach() * point.normal};
  std::array<Point, 2> box{};
  for (std::size_t d = 0; d < 3; ++d) {
    const auto [least, most] = std::minmax(ends[0][index(d)], ends[1][index(d)]);
    box[0][d] = least;
    box[1][d] = most;
  }
  std::vector<std::size_t> found;
  other.tree->meeting(box, found);
  Opposite opposite;
  for (const std::size_t number : found) {
    const Facet& candidate = other.facets[number];
    if (shareNodes(facet, candidate))
      return {};
    const std::optional<Foot> foot = footOn(candidate, point.place, point.normal);
    if (foot && std::abs(foot->distance) <= reach() && std::abs(foot->distance) < std::abs(opposite.gap) &&
        foot->normal.dot(point.normal) <= opposed_)
      opposite = {foot->distance, facet.sag + candidate.sag};
  }
  return opposite;
}

void FacetPairs::sample(const SearchedFace& from, const SearchedFace& to, FacePair& pair, bool countsArea,
                        Nearest& nearest) const {
  std::map<mesh::CellType, std::vector<Sample>> samples;
  for (const Facet& facet : from.facets) {
    if (!areNear(facet.box, to.box, reach()))
      continue;
    std::vector<Sample>& own = samples[facet.type];
    if (own.empty())
      own = samplesOf(facet.type);
    for (const Sample& sample : own) {
      const FacetPoint point = facet.at(sample.xi);
      const Opposite opposite = oppositeOf(point, facet, to);
      const double closer = std::abs(nearest.opposite.gap) - std::abs(opposite.gap), same = 1e-6 * distance_;
      if (closer > same || (closer > -same && opposite.sag < nearest.opposite.sag))
        nearest = {&to, &facet, sample.xi, opposite};
      if (std::abs(opposite.gap) > distance_)
        continue;
      if (countsArea)
        pair.area += sample.weight * point.stretch;
      pair.leastGap = std::min(pair.leastGap, opposite.gap);
      pair.largestGap = std::max(pair.largestGap, opposite.gap);
    }
  }
}

/// In smaller and smaller steps on the facet.
void FacetPairs::descend(Nearest& nearest) const {
  mesh::withFacetShape(nearest.facet->type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    constexpr int halvings = 12;
    for (double step = 1.0 / 8; step > std::pow(0.5, halvings);) {
      const Vector2d last = nearest.xi;
      for (int i = -1; i <= 1; ++i)
        for (int j = (dim == 1 ? 0 : -1); j <= (dim == 1 ? 0 : 1); ++j) {
          const Vector2d xi = last + step * Vector2d(i, j);
          if (!isInside<dim>(shape, xi.head<dim>()))
            continue;
          const Opposite other = oppositeOf(nearest.facet->at(xi), *nearest.facet, *nearest.to);
          if (std::abs(other.gap) < std::abs(nearest.opposite.gap) - 1e-9 * distance_) {
            nearest.opposite = other;
            nearest.xi = xi;
          }
        }
      if (nearest.xi == last)
        step /= 2;
    }
  });
}

void FacetPairs::look(int a, int b) {
  Assembly& assembly = faces_.assembly;
  const auto boxOf = [&](int face) {
    const mesh::Box& box = assembly.solids[index(assembly.faces[index(face)].solid)].box;
    return std::array{box.lower, box.upper};
  };
  if (!areNear(boxOf(a), boxOf(b), reach()))
    return;
  if (assembly.faces[index(a)].area > assembly.faces[index(b)].area)
    std::swap(a, b);
  const SearchedFace &first = searched(a), &second = searched(b);
  if (!areNear(first.box, second.box, reach()))
    return;
  FacePair pair{a, b, 0, nowhere, -nowhere, {}};
  Nearest nearest;
  sample(first, second, pair, true, nearest);
  sample(second, first, pair, false, nearest);
  if (nearest.facet == nullptr)
    return;
  descend(nearest);
  const double least = nearest.opposite.gap;
  const Vector3d place = nearest.facet->at(nearest.xi).place;
  pair.closest = {place[0], place[1], place[2]};
  pair.leastGap = std::min(pair.leastGap, least);
  pair.largestGap = std::max(pair.largestGap, least);
  pair.sag = nearest.opposite.sag;
  const double unsure = pair.sag > smallSag * distance_ ? pair.sag : 0;
  const bool mayBeNear = std::abs(least) - unsure <= distance_;
  (mayBeNear ? assembly.pairs : assembly.nearMisses).push_back(pair);
}

} // namespace

void findPairs(std::span<const MeshedBody> bodies, const PairSearch& search, MeshFaces& faces) {
  FacetPairs pairs(bodies, search, faces);
  const std::vector<Face>& all = faces.assembly.faces;
  for (int a = 0; a < std::ssize(all); ++a)
    for (int b = a + 1; b < std::ssize(all); ++b)
      if (all[index(a)].solid != all[index(b)].solid)
        pairs.look(a, b);
}

} // namespace epafi::assembly
