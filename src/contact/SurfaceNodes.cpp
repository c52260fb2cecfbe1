#include "epafi/contact/SurfaceNodes.hpp"

#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace epafi::contact {

namespace {

void pointsAt(const NodePoints& pointAt, std::span<const GlobalOrdinal> nodes, std::vector<Point>& points) {
  points.clear();
  for (const GlobalOrdinal node : nodes)
    points.push_back(pointAt(node));
}

/// Facets of order 1 as those of order 2, with the points between their corners numbered on from the
/// surface's nodes.
class Completion {
public:
  Completion(const NodePoints& pointAt, const mesh::Surface& surface)
      : pointAt_(pointAt), surface_(surface),
        next_(1 + *std::max_element(surface.facetNodes.begin(), surface.facetNodes.end())) {}

  /// Nodes and points of facet f. \param shares  what each stands for
  void facet(std::size_t f, std::vector<GlobalOrdinal>& nodes, std::vector<Point>& points,
             std::vector<std::vector<NodeShare>>& shares) {
    const auto corners = surface_.facet(f);
    pointsAt(pointAt_, corners, points);
    nodes.assign(corners.begin(), corners.end());
    shares.clear();
    for (const GlobalOrdinal node : corners)
      shares.push_back({{node, 1.0}});
    const std::span<const int> edges = edgesOf(surface_.typeOf(f));
    for (std::size_t e = 0; e < edges.size(); e += 2)
      add(std::array{corners[edges[e]], corners[edges[e + 1]]}, nodes, points, shares);
    if (surface_.typeOf(f) == mesh::CellType::quadrilateral)
      add(corners, nodes, points, shares);
  }

private:
  void add(std::span<const GlobalOrdinal> between, std::vector<GlobalOrdinal>& nodes,
           std::vector<Point>& points, std::vector<std::vector<NodeShare>>& shares) {
    std::vector<GlobalOrdinal> key(between.begin(), between.end());
    std::sort(key.begin(), key.end());
    std::vector<NodeShare> share;
    for (const GlobalOrdinal node : key)
      share.push_back({node, 1.0 / static_cast<double>(key.size())});
    const auto [place, isNew] = number_.try_emplace(std::move(key), next_);
    next_ += isNew ? 1 : 0;
    nodes.push_back(place->second);
    std::vector<Point> around;
    pointsAt(pointAt_, between, around);
    points.push_back(mesh::centreOf(around));
    shares.push_back(std::move(share));
  }

  const NodePoints& pointAt_;
  const mesh::Surface& surface_;
  std::map<std::vector<GlobalOrdinal>, GlobalOrdinal> number_;
  GlobalOrdinal next_;
};

/// action(nodes, points, shares) for all facets.
template <class Action>
void forEachFacet(const NodePoints& pointAt, const mesh::Surface& surface, bool complete,
                  const Action& action) {
  Completion completion(pointAt, surface);
  std::vector<GlobalOrdinal> nodes;
  std::vector<Point> points;
  std::vector<std::vector<NodeShare>> shares;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    if (complete) {
      completion.facet(f, nodes, points, shares);
    } else {
      nodes.assign(surface.facet(f).begin(), surface.facet(f).end());
      pointsAt(pointAt, nodes, points);
    }
    action(nodes, points, shares);
  }
}

/// Adds a facet's normal to that of the face which it continues, or begins one.
void addTo(std::vector<Eigen::Vector3d>& faces, const Eigen::Vector3d& normal) {
  for (Eigen::Vector3d& face : faces)
    if (face.dot(normal) >= sharpBend * face.norm() * normal.norm()) {
      face += normal;
      return;
    }
  faces.push_back(normal);
}

} // namespace

SurfaceNodes surfaceNodes(const NodePoints& pointAt, const mesh::Surface& surface, int order,
                          bool isOfRevolution) {
  const bool complete = order > orderOf(surface.facetType);
  const mesh::CellType largest = complete ? withOrder(surface.facetType, order) : surface.facetType;
  std::map<GlobalOrdinal, std::size_t> placeOf;
  forEachFacet(pointAt, surface, complete, [&](const auto& nodes, const auto&, const auto&) {
    for (const GlobalOrdinal node : nodes)
      placeOf.emplace(node, 0);
  });
  SurfaceNodes result;
  for (auto& [node, place] : placeOf) {
    place = result.nodes.size();
    result.nodes.push_back(node);
    result.shares.push_back({{node, 1.0}});
  }
  result.points.resize(result.nodes.size());
  result.normals.assign(result.nodes.size(), Eigen::Vector3d::Zero());
  result.areas.assign(result.nodes.size(), 0.0);
  result.spacings.assign(result.nodes.size(), 0.0);
  result.faces.resize(result.nodes.size());
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> areas;
  forEachFacet(pointAt, surface, complete, [&](const auto& nodes, const auto& points, const auto& shares) {
    const mesh::CellType facetType = cellOf(largest, points.size());
    areas.resize(points.size());
    mesh::nodalNormals(facetType, points, normals);
    mesh::nodalShares(facetType, points, areas);
    auto& facet = result.facets.emplace_back();
    facet.numCorners = numCornersOf(facetType);
    facet.normal = mesh::areaVector(facetType, points).normalized();
    const double even = std::accumulate(areas.begin(), areas.end(), 0.0) / static_cast<double>(areas.size());
    if (isOfRevolution)
      mesh::revolvedShares(facetType, points, areas);
    facet.shares = areas;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::size_t place = placeOf.at(nodes[a]);
      facet.nodes.push_back(place);
      if (complete)
        result.shares[place] = shares[a];
      result.points[place] = Eigen::Vector3d(points[a][0], points[a][1], points[a][2]);
      result.normals[place] += normals[a];
      addTo(result.faces[place], normals[a]);
      result.areas[place] += areas[a];
      result.spacings[place] += even;
    }
  });
  for (Eigen::Vector3d& normal : result.normals)
    normal.normalize();
  for (std::vector<Eigen::Vector3d>& faces : result.faces)
    if (faces.size() == 1)
      faces.clear();
  if (dimensionOf(largest) == 2)
    for (double& spacing : result.spacings)
      spacing = std::sqrt(spacing);
  return result;
}

} // namespace epafi::contact
