#include "epafi/fem/BodyModel.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/GridWalk.hpp"
#include "epafi/fem/Q1Element.hpp"

#include <algorithm>

namespace epafi::fem {
namespace {

/// Whether x lies in [low, high]; the ends belong to it, round-off of x beside the element's size included.
bool lies(double x, double low, double high, double elementSize) {
  const double roundOff = 1e-9 * elementSize;
  return low - roundOff <= x && x <= high + roundOff;
}

/// Ends of the columns or rows of elements.
using Segments = std::vector<std::array<double, 2>>;

Segments segmentsAlongX(const RectangleMesh& mesh) {
  Segments segments;
  for (GlobalOrdinal i = 0; i < mesh.elements()[0]; ++i) {
    const scene::Rectangle box = mesh.elementBox(i);
    segments.push_back({box.x0, box.x1});
  }
  return segments;
}

Segments segmentsAlongY(const RectangleMesh& mesh) {
  Segments segments;
  for (GlobalOrdinal j = 0; j < mesh.elements()[1]; ++j) {
    const scene::Rectangle box = mesh.elementBox(j * mesh.elements()[0]);
    segments.push_back({box.y0, box.y1});
  }
  return segments;
}

/// The segments whose middle lies in [low, high]: the first one, and the one after the last.
std::array<GlobalOrdinal, 2> within(const Segments& segments, double low, double high) {
  const auto lie = [&](const std::array<double, 2>& s) {
    return lies(0.5 * (s[0] + s[1]), low, high, s[1] - s[0]);
  };
  const auto first = std::find_if(segments.begin(), segments.end(), lie);
  return {first - segments.begin(), std::find_if_not(first, segments.end(), lie) - segments.begin()};
}

std::vector<Eigen::Vector2d> loadsOn(const Segments& segments, double low, double high) {
  std::vector<Eigen::Vector2d> loads;
  for (const auto& [a, b] : segments)
    loads.push_back(segmentLoad(a, b, low, high));
  return loads;
}

/// \throws InputError if two supports give a corner different values.
void requireAgreement(const scene::Body& body, const RectangleMesh& mesh) {
  for (std::size_t a = 0; a < body.supports.size(); ++a)
    for (std::size_t b = a + 1; b < body.supports.size(); ++b) {
      const GlobalOrdinal last = mesh.numEdgeNodes(body.supports[a].edge) - 1;
      const bool meet =
          mesh.positionOnEdge(body.supports[b].edge, mesh.edgeNode(body.supports[a].edge, 0)) >= 0 ||
          mesh.positionOnEdge(body.supports[b].edge, mesh.edgeNode(body.supports[a].edge, last)) >= 0;
      if (meet && body.supports[a].value != body.supports[b].value)
        throw InputError("the supports '" + body.supports[a].name + "' and '" + body.supports[b].name +
                         "' of body '" + body.name + "' meet in a corner with different values (" +
                         std::to_string(body.supports[a].value) + " and " +
                         std::to_string(body.supports[b].value) + "); give both the same value");
    }
}

} // namespace

void BodyModel::element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const {
  GlobalOrdinal kind = 0;
  Eigen::MatrixXd column;
  kinds(std::span(&element, 1), std::span(&kind, 1));
  this->stiffness(kind, stiffness);
  loads(std::span(&element, 1), column);
  load = column.col(0);
}

void BodyModel::regions(std::span<const GlobalOrdinal> /*elements*/, std::span<GlobalOrdinal> regions) const {
  std::fill(regions.begin(), regions.end(), GlobalOrdinal{0});
}

MembraneModel::MembraneModel(const scene::Body& body, const RectangleMesh& mesh) : body_(body), mesh_(mesh) {
  requireAgreement(body, mesh);
  const scene::Rectangle& r = mesh.rectangle();
  unitStiffness_ = membraneStiffness((r.x1 - r.x0) / mesh.elements()[0], (r.y1 - r.y0) / mesh.elements()[1]);
  const Segments columns = segmentsAlongX(mesh), rows = segmentsAlongY(mesh);
  for (const scene::Region& region : body.regions)
    patches_.push_back(
        {within(columns, region.box.x0, region.box.x1), within(rows, region.box.y0, region.box.y1)});
  for (const scene::Load& l : body.loads)
    strips_.push_back({l.value, loadsOn(columns, l.box.x0, l.box.x1), loadsOn(rows, l.box.y0, l.box.y1)});
}

std::optional<double> MembraneModel::prescribed(GlobalOrdinal node, int /*component*/) const {
  for (const scene::Support& support : body_.supports)
    if (mesh_.positionOnEdge(support.edge, node) >= 0)
      return support.value;
  return std::nullopt;
}

void MembraneModel::prescribed(std::span<const GlobalOrdinal> nodes,
                               std::vector<PrescribedValue>& values) const {
  values.clear();
  std::vector<std::size_t> places;
  for (const scene::Support& support : body_.supports) {
    mesh_.placesOnEdge(support.edge, nodes, places);
    for (const std::size_t place : places)
      values.push_back({place, support.value});
  }
}

void MembraneModel::regions(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> regions) const {
  std::fill(regions.begin(), regions.end(), GlobalOrdinal{0});
  const auto contains = [](const std::array<GlobalOrdinal, 2>& range, GlobalOrdinal value) {
    return range[0] <= value && value < range[1];
  };
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    GridWalk walk(mesh_.elements()[0]);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      walk.to(elements[e]);
      if (contains(patches_[p].columns, walk.column()) && contains(patches_[p].rows, walk.row()))
        regions[e] = static_cast<GlobalOrdinal>(p) + 1; // the last region in the file holds
    }
  }
}

void MembraneModel::stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const {
  const double conductivity =
      kind == 0 ? body_.conductivity : body_.regions[static_cast<std::size_t>(kind) - 1].conductivity;
  stiffness = conductivity * unitStiffness_;
}

void MembraneModel::loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const {
  loads.setZero(4, static_cast<Eigen::Index>(elements.size()));
  for (const Strips& strips : strips_) {
    GridWalk walk(mesh_.elements()[0]);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      walk.to(elements[e]);
      loads.col(static_cast<Eigen::Index>(e)) +=
          strips.value * membraneLoad(strips.alongX[static_cast<std::size_t>(walk.column())],
                                      strips.alongY[static_cast<std::size_t>(walk.row())]);
    }
  }
}

} // namespace epafi::fem
