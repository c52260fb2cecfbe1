#include "epafi/fem/BodyModel.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/Q1Element.hpp"

namespace epafi::fem {
namespace {

/// Whether x lies in [low, high]; the ends belong to it, round-off of x beside the element's size included.
bool lies(double x, double low, double high, double elementSize) {
  const double roundOff = 1e-9 * elementSize;
  return low - roundOff <= x && x <= high + roundOff;
}

} // namespace

MembraneModel::MembraneModel(const scene::Body& body, const RectangleMesh& mesh) : body_(body), mesh_(mesh) {
  const scene::Rectangle& r = mesh.rectangle();
  unitStiffness_ = membraneStiffness((r.x1 - r.x0) / mesh.elements()[0], (r.y1 - r.y0) / mesh.elements()[1]);
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

std::optional<double> MembraneModel::prescribed(GlobalOrdinal node, int /*component*/) const {
  for (const scene::Support& support : body_.supports)
    if (mesh_.positionOnEdge(support.edge, node) >= 0)
      return support.value;
  return std::nullopt;
}

void MembraneModel::element(GlobalOrdinal element, Eigen::MatrixXd& stiffness, Eigen::VectorXd& load) const {
  const scene::Rectangle box = mesh_.elementBox(element);
  const double x = 0.5 * (box.x0 + box.x1), y = 0.5 * (box.y0 + box.y1);
  double conductivity = body_.conductivity;
  for (const scene::Region& region : body_.regions)
    if (lies(x, region.box.x0, region.box.x1, box.x1 - box.x0) &&
        lies(y, region.box.y0, region.box.y1, box.y1 - box.y0))
      conductivity = region.conductivity;
  stiffness = conductivity * unitStiffness_;
  load.setZero(4);
  for (const scene::Load& l : body_.loads)
    load += l.value * membraneLoad(box, l.box);
}

} // namespace epafi::fem
