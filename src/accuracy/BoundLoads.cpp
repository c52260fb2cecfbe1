#include "epafi/accuracy/BoundLoads.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::accuracy {
namespace {

using fem::SolidLoad;
using fem::SolidSupport;

[[noreturn]] void refuse(const BoundCells& cells, const std::string& why) {
  throw InputError("guaranteed bounds are not there for " + why + ", as body '" + cells.body().name +
                   "' has; leave out \"Bound\"");
}

void requireCovered(const BoundCells& cells) {
  if (cells.body().reducedIntegration)
    refuse(cells, "reduced integration");
  if (!cells.body().stiffnessFactors.empty())
    refuse(cells, "factors of the stiffness");
  if (cells.model().hasFrames())
    refuse(cells, "supports along other axes than those of space");
  for (const SolidLoad& load : cells.body().loads) {
    if (load.kind == SolidLoad::Kind::point)
      refuse(cells, "forces at points");
    if (load.kind == SolidLoad::Kind::distributed)
      refuse(cells, "loads of the kind distributed");
    if (load.kind == SolidLoad::Kind::temperature)
      refuse(cells, "changes of temperature");
    if (load.kind == SolidLoad::Kind::rotation)
      refuse(cells, "forces of rotation");
  }
}

bool hasSurface(const mesh::Mesh& mesh, const std::string& name) {
  const std::vector<std::string> names = mesh.surfaceNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The axis of space that is most nearly normal to a facet.
std::size_t axisAcross(const std::vector<Point>& points, std::size_t dimension) {
  Eigen::Vector3d normal;
  const auto to = [&](std::size_t i) -> Eigen::Vector3d {
    return {points[i][0] - points[0][0], points[i][1] - points[0][1], points[i][2] - points[0][2]};
  };
  normal = to(1).cross(dimension == 2 ? Eigen::Vector3d::UnitZ().eval() : to(2));
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return axis;
}

void addSupports(const BoundCells& cells, BoundaryFacets& facets) {
  std::vector<Point> points;
  for (const SolidSupport& support : cells.body().supports) {
    if (!hasSurface(cells.mesh(), support.surface))
      refuse(cells, "supports of single nodes");
    const mesh::Surface surface = cells.mesh().surface(support.surface);
    for (std::size_t f = 0; f < surface.numFacets(); ++f) {
      BoundaryFacet& facet = addForces(facets, surface.typeOf(f), surface.facet(f),
                                       Eigen::MatrixXd::Zero(cells.components(), surface.nodesPerFacet()));
      cells.mesh().pointsAt(surface.facet(f), points);
      const std::size_t across = axisAcross(points, dimensionOf(cells.mesh().cellType()));
      for (std::size_t c = 0; c < 3; ++c)
        if (support.value.at(c) || (support.normal && c == across))
          facet.isHeld.at(c) = true;
    }
  }
}

void addTractions(const BoundCells& cells, BoundaryFacets& facets) {
  std::vector<Point> points;
  Eigen::VectorXd values;
  for (const SolidLoad& load : cells.body().loads) {
    const bool isPressure = load.kind == SolidLoad::Kind::pressure;
    if (!isPressure && load.kind != SolidLoad::Kind::traction)
      continue;
    const mesh::Surface surface = cells.mesh().surface(load.where);
    for (std::size_t f = 0; f < surface.numFacets(); ++f) {
      cells.mesh().pointsAt(surface.facet(f), points);
      const fem::Material& material = cells.model().materialOf(surface.elements[f]);
      if (isPressure)
        fem::pressureLoad(surface.facetType, points, cells.body().physics, material, load.value[0], values);
      else
        fem::tractionLoad(surface.facetType, points, cells.body().physics, material, load.value, values);
      addForces(facets, surface.typeOf(f), surface.facet(f),
                values.reshaped(cells.components(), surface.nodesPerFacet()));
    }
  }
}

/// What of an element a load's box takes, from 0 to 1.
double shareOf(const mesh::StructuredMesh& mesh, GlobalOrdinal element, const mesh::Box& box) {
  constexpr double roundOff = 1e-9;
  mesh::GridWalk walk = mesh.elementWalk();
  walk.to(element);
  double share = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimensionOf(mesh.cellType())); ++d) {
    const double from = mesh.coordinate(d, walk[d]), to = mesh.coordinate(d, walk[d] + 1);
    const double part =
        std::max(0.0, std::min(to, box.upper.at(d)) - std::max(from, box.lower.at(d))) / (to - from);
    share *= part < roundOff ? 0 : part > 1 - roundOff ? 1 : part;
  }
  return share;
}

void addBodyForces(const BoundCells& cells, BoundLoads& loads) {
  const auto components = static_cast<Eigen::Index>(cells.components());
  const fem::SolidBody body(cells.body(), cells.mesh());
  std::vector<GlobalOrdinal> elements;
  std::vector<double> thickness, measure;
  std::optional<fem::CellStress> own;
  for (std::size_t place = 0; place < cells.number(); ++place) {
    elements.push_back(cells.elementAt(place));
    thickness.push_back(fem::thicknessOf(cells.body().physics, cells.materialAt(place)));
    measure.push_back(cells.stressAt(place, own).measure());
  }
  for (const SolidLoad& load : cells.body().loads) {
    if (load.kind != SolidLoad::Kind::body)
      continue;
    const Eigen::VectorXd value = Eigen::Map<const Eigen::Vector3d>(load.value.data()).head(components);
    const auto add = [&](std::size_t place, double share) {
      loads.load.col(place) += share * thickness[place] * value;
      if (share < 1 && place < cells.numOwn())
        loads.missing[place] +=
            thickness[place] * value.norm() * std::sqrt(share * (1 - share) * measure[place]);
      if (share < 1 && components > 1)
        refuse(cells, "loads that end inside of elements");
    };
    if (!load.wholeElements && body.isCongruent()) {
      for (std::size_t place = 0; place < elements.size(); ++place)
        if (const double share = shareOf(*cells.mesh().structured(), elements[place], load.box); share > 0)
          add(place, share);
    } else {
      fem::SolidDomain(body, "load '" + load.name + "'", load.where, load.box, true)
          .forEachIn(body, elements, [&](std::size_t place) { add(place, 1); });
    }
  }
}

} // namespace

BoundaryFacet& addForces(BoundaryFacets& facets, mesh::CellType type, std::span<const GlobalOrdinal> nodes,
                         const Eigen::MatrixXd& forces) {
  BoundaryFacet& facet = facets[facetKey(type, nodes)];
  if (facet.nodes.empty()) {
    facet.nodes.assign(nodes.begin(), nodes.end());
    facet.forces = forces;
    return facet;
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    facet.forces.col(std::find(facet.nodes.begin(), facet.nodes.end(), nodes[i]) - facet.nodes.begin()) +=
        forces.col(i);
  return facet;
}

BoundLoads boundLoads(const BoundCells& cells) {
  requireCovered(cells);
  const Eigen::Index components = cells.components();
  BoundLoads loads;
  addSupports(cells, loads.facets);
  addTractions(cells, loads.facets);
  loads.load = Eigen::MatrixXd::Zero(components, cells.number());
  loads.missing.assign(cells.numOwn(), 0.0);
  addBodyForces(cells, loads);
  std::vector<GlobalOrdinal> elements;
  for (std::size_t place = 0; place < cells.number(); ++place)
    elements.push_back(cells.elementAt(place));
  cells.model().loads(elements, loads.whole);
  loads.volume = loads.whole;
  for (std::size_t place = 0; place < cells.number(); ++place)
    for (int k = 0; k < std::ssize(cells.facets()); ++k) {
      const auto found = loads.facets.find(cells.facetAt(place, k));
      if (found == loads.facets.end())
        continue;
      const auto nodes = cells.nodesAt(place);
      for (std::size_t i = 0; i < found->second.nodes.size(); ++i) {
        const auto a = std::find(nodes.begin(), nodes.end(), found->second.nodes[i]) - nodes.begin();
        loads.volume.col(place).segment(a * components, components) -= found->second.forces.col(i);
      }
    }
  return loads;
}

} // namespace epafi::accuracy
