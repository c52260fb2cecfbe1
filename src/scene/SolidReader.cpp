#include "epafi/scene/SolidReader.hpp"

#include "epafi/base/ParameterValue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::scene {
namespace {

bool isElastic(Physics physics) {
  return physics != Physics::membrane;
}

std::string of(Physics physics) {
  return isElastic(physics) ? "bodies of the physics \"" + toString(physics) + '"' : "membranes";
}

std::string text(const std::array<int, 3>& counts, int dimension) {
  return '{' + std::to_string(counts[0]) + ", " + std::to_string(counts[1]) +
         (dimension == 3 ? ", " + std::to_string(counts[2]) : "") + '}';
}

/// What is not given is as in `outer`. Of a region nothing is required.
Material readMaterial(const ListReader& list, Physics physics, const Material& outer, bool isRegion) {
  const std::string useless = of(physics) + " have none; remove it";
  Material material = outer;
  const auto take = [&](const char* name, double& value) {
    if (list.has(name))
      value = list.positive(name);
  };
  if (!isElastic(physics)) {
    list.refuseGiven({"Young's Modulus", "Poisson's Ratio", "Thickness"}, useless);
    take("Conductivity", material.conductivity);
    return material;
  }
  list.refuseGiven({"Conductivity"}, useless);
  if (physics == Physics::elasticity3d)
    list.refuseGiven({"Thickness"}, useless);
  if (!isRegion)
    for (const char* const name : {"Young's Modulus", "Poisson's Ratio"})
      list.require(name, " of an elastic body");
  take("Young's Modulus", material.youngsModulus);
  take("Thickness", material.thickness);
  if (list.has("Poisson's Ratio"))
    material.poissonsRatio = list.real("Poisson's Ratio");
  return material;
}

MeshSource readMesh(const ListReader& list, int dimension) {
  MeshSource source;
  const std::string extent = dimension == 3 ? "Box" : "Rectangle";
  if (list.hasEntries("Mesh")) {
    list.refuseGiven({"Rectangle", "Box", "Elements"}, "the body has a mesh file; remove one of them");
    source.file = list.file("Mesh");
    source.sizeFactor = list.positive("Mesh Size Factor");
    if (!source.file.ends_with(".geo"))
      list.refuseGiven({"Mesh Size Factor"}, "only a geometry (.geo) is meshed in a size of your choice");
    source.refinements = list.integer("Mesh Refinements");
    source.group = list.word("Group");
    return source;
  }
  list.refuseGiven({"Group", "Mesh Size Factor", "Mesh Refinements"},
                   "the body has no mesh file that it could apply to");
  list.refuseGiven({dimension == 3 ? "Rectangle" : "Box"},
                   "a body in " +
                       std::string(dimension == 3 ? "space has a \"Box\"" : "the plane has a \"Rectangle\""));
  for (const std::string& name : {extent, std::string("Elements")})
    list.require(name, " unless it has a mesh file");
  source.box = list.box(extent, dimension);
  source.elements = list.counts("Elements", dimension);
  requireTellableNodes(list, extent, source.box, source.elements, dimension);
  if (dimension == 2)
    source.elements[2] = 0;
  return source;
}

/// A box that meets the body's own, if this is known.
Box boxIn(const ListReader& list, const MeshSource& mesh, int dimension) {
  const Box box = list.box("Box", dimension);
  if (mesh.file.empty())
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      if (!(std::max(box.lower[d], mesh.box.lower[d]) < std::min(box.upper[d], mesh.box.upper[d])))
        list.refuseValue("Box", "must overlap the body, which in " + std::string(1, "xyz"[d]) +
                                    " goes from " + valueText(mesh.box.lower[d]) + " to " +
                                    valueText(mesh.box.upper[d]));
  return box;
}

void requireOneDomain(const ListReader& list, const MeshSource& mesh) {
  if (list.hasEntries("Box"))
    list.refuseGiven({"Group"}, "there is a box, too; give one of them");
  if (mesh.file.empty())
    list.refuseGiven({"Group"}, "the body has no mesh file with groups; give a box");
}

std::vector<SolidRegion> readRegions(const ListReader& list, Physics physics, const Solid& solid) {
  std::vector<SolidRegion> regions;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    SolidRegion region{name, {}, entry.word("Group"), readMaterial(entry, physics, solid.material, true)};
    requireOneDomain(entry, solid.mesh);
    if (region.group.empty()) {
      entry.require("Box", solid.mesh.file.empty() ? "" : " unless there is a group");
      region.box = boxIn(entry, solid.mesh, dimensionOf(physics));
    }
    regions.push_back(region);
  }
  return regions;
}

std::vector<SolidSupport> readSupports(const ListReader& list, Physics physics) {
  std::vector<SolidSupport> supports;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    entry.refuseGiven({"Edge"}, "only membranes on rectangles have edges; name the \"Surface\"");
    entry.require("Surface");
    SolidSupport support{name, entry.word("Surface"), {}, {}};
    if (!isElastic(physics)) {
      entry.refuseGiven({"X", "Y", "Z", "Normal"}, "a membrane's deflection is its \"Value\"");
      support.value[0] = entry.real("Value");
    } else {
      entry.refuseGiven({"Value"},
                        "the components \"X\", \"Y\" and \"Z\" say what is held of an elastic body");
      if (dimensionOf(physics) == 2)
        entry.refuseGiven({"Z"}, "the body lies in the plane");
      bool holds = false;
      for (int c = 0; c < componentsOf(physics); ++c)
        if (const std::string component(1, "XYZ"[c]); entry.has(component)) {
          support.value[static_cast<std::size_t>(c)] = entry.real(component);
          holds = true;
        }
      if (entry.has("Normal")) {
        support.normal = entry.real("Normal");
        holds = true;
      }
      if (!holds)
        entry.refuseList(
            "holds nothing; give at least one of the components that it prescribes, \"X\", \"Y\"" +
            std::string(dimensionOf(physics) == 3 ? ", \"Z\"" : "") + ", or \"Normal\"");
    }
    supports.push_back(support);
  }
  return supports;
}

/// Where a load acts; the parameters of the other kinds are refused.
void readPlace(const ListReader& list, const Solid& solid, SolidLoad& load) {
  const std::string reason = "a load of the kind \"" + list.word("Kind") + "\" has no use for it";
  using Kind = SolidLoad::Kind;
  if (load.kind != Kind::body)
    list.refuseGiven({"Box", "Group"}, reason);
  if (load.kind == Kind::body || load.kind == Kind::point)
    list.refuseGiven({"Surface"}, reason);
  if (load.kind != Kind::point)
    list.refuseGiven({"Point"}, reason);
  const int dimension = dimensionOf(solid.physics);
  if (load.kind == Kind::body) {
    requireOneDomain(list, solid.mesh);
    load.where = list.word("Group");
    if (list.hasEntries("Box"))
      load.box = boxIn(list, solid.mesh, dimension);
  } else if (load.kind == Kind::point) {
    list.require("Point");
    load.point = list.vector("Point", dimension);
  } else {
    list.require("Surface");
    load.where = list.word("Surface");
  }
}

SolidLoad::Kind kindOf(const std::string& word) {
  using Kind = SolidLoad::Kind;
  return word == "body"       ? Kind::body
         : word == "traction" ? Kind::traction
         : word == "pressure" ? Kind::pressure
                              : Kind::point;
}

std::vector<SolidLoad> readLoads(const ListReader& list, const Solid& solid) {
  std::vector<SolidLoad> loads;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    SolidLoad load;
    load.name = name;
    load.kind = kindOf(entry.word("Kind"));
    if (load.kind == SolidLoad::Kind::pressure && !isElastic(solid.physics))
      entry.refuseValue("Kind", "membranes carry no pressure on their edges; give a traction");
    readPlace(entry, solid, load);
    if (!isElastic(solid.physics) || load.kind == SolidLoad::Kind::pressure) {
      entry.refuseGiven({"Force"}, "a load of this kind is a number, its \"Value\"");
      entry.require("Value");
      load.value[0] = entry.real("Value");
    } else {
      entry.refuseGiven({"Value"}, "a load of this kind has components, its \"Force\"");
      entry.require("Force");
      load.value = entry.vector("Force", dimensionOf(solid.physics));
    }
    loads.push_back(load);
  }
  return loads;
}

} // namespace

int dimensionOf(Physics physics) {
  return physics == Physics::elasticity3d ? 3 : 2;
}

void requireTellableNodes(const ListReader& list, const std::string& extent, const Box& box,
                          const std::array<int, 3>& elements, int dimension) {
  constexpr double mostNodes = std::numeric_limits<int>::max();
  double numNodes = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    numNodes *= elements[d] + 1.0;
  if (numNodes > mostNodes)
    list.refuseValue("Elements", "that makes " + valueText(numNodes) + " nodes and a body may have at most " +
                                     valueText(mostNodes));
  constexpr double relativeWidth = 1e-12;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
    const double farthest = std::max(std::abs(box.lower[d]), std::abs(box.upper[d]));
    if ((box.upper[d] - box.lower[d]) / elements[d] <= relativeWidth * farthest)
      list.refuseValue(extent, "elements of its size over " + text(elements, dimension) +
                                   " are too thin at that distance from the origin to be told apart");
  }
}

Solid readSolid(const ListReader& list, Physics physics) {
  Solid solid;
  solid.physics = physics;
  solid.mesh = readMesh(list, dimensionOf(physics));
  solid.material = readMaterial(list, physics, {}, false);
  solid.regions = readRegions(list.inside("Regions"), physics, solid);
  solid.supports = readSupports(list.inside("Supports"), physics);
  solid.loads = readLoads(list.inside("Loads"), solid);
  return solid;
}

} // namespace epafi::scene
