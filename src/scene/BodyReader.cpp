#include "epafi/scene/BodyReader.hpp"

#include "epafi/base/ParameterValue.hpp"
#include "epafi/scene/EdgeContact.hpp"
#include "epafi/scene/MaterialReader.hpp"
#include "epafi/scene/MeshReader.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace epafi::scene {
namespace {

bool isElastic(const Body& body) {
  return body.physics != fem::Physics::membrane;
}

bool isOfRevolution(const Body& body) {
  return body.physics == fem::Physics::axisymmetric;
}

int dimensionOf(const Body& body) {
  return dimensionOf(body.physics);
}

fem::Physics physicsOf(const std::string& word) {
  for (const fem::Physics physics : {fem::Physics::planeStrain, fem::Physics::planeStress,
                                     fem::Physics::elasticity3d, fem::Physics::axisymmetric})
    if (toString(physics) == word)
      return physics;
  return fem::Physics::membrane;
}

/// A box that meets the body's own, if this is known.
mesh::Box boxIn(const ListReader& list, const Body& body) {
  const mesh::Box box = list.box("Box", dimensionOf(body));
  if (body.mesh.file.empty())
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimensionOf(body)); ++d) {
      const double lower = body.mesh.box.lower[d], upper = body.mesh.box.upper[d];
      if (!(std::max(box.lower[d], lower) < std::min(box.upper[d], upper)))
        list.refuseValue("Box", "must overlap the body, which in " + std::string(1, "xyz"[d]) +
                                    " goes from " + valueText(lower) + " to " + valueText(upper));
    }
  return box;
}

void requireOneDomain(const ListReader& list, const meshing::MeshSource& mesh) {
  if (list.hasEntries("Box"))
    list.refuseGiven({"Group"}, "there is a box, too; give one of them");
  if (mesh.file.empty())
    list.refuseGiven({"Group"}, "the body has no mesh file with groups; give a box");
}

std::vector<fem::SolidRegion> readRegions(const ListReader& list, const Body& body) {
  std::vector<fem::SolidRegion> regions;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    fem::SolidRegion region{
        name, {}, entry.word("Group"), readMaterial(entry, body.physics, body.material, true)};
    requireOneDomain(entry, body.mesh);
    if (region.group.empty()) {
      entry.require("Box", body.mesh.file.empty() ? "" : " unless there is a group");
      region.box = boxIn(entry, body);
    }
    region.mayBeEmpty = isMembraneOnRectangle(body);
    if (region.mayBeEmpty)
      entry.require("Conductivity");
    regions.push_back(region);
  }
  return regions;
}

/// Throws unless an edge has no support yet and those that it meets in corners have its value.
void requireAgreement(const ListReader& entry, const fem::SolidSupport& support,
                      const std::vector<fem::SolidSupport>& others) {
  const auto isVertical = [](const fem::SolidSupport& s) {
    return s.surface == "left" || s.surface == "right";
  };
  for (const fem::SolidSupport& other : others) {
    if (other.surface == support.surface)
      entry.refuseValue("Edge", "that edge has the support \"" + other.name + "\" already");
    if (isVertical(other) != isVertical(support) && other.value != support.value)
      entry.refuseValue("Value", "must equal the value " + valueText(*other.value[0]) + " of the support \"" +
                                     other.name + "\", with which it shares a corner");
  }
}

/// Nothing where they are those of space.
std::optional<fem::LocalAxes> readAxes(const ListReader& entry, int dimension) {
  const bool isCylindrical = entry.hasEntries("Cylinder");
  if (isCylindrical && entry.hasEntries("Axes"))
    entry.refuseGiven({"Axes"}, "there is a \"Cylinder\", too; give one of them");
  if (!isCylindrical && !entry.hasEntries("Axes"))
    return std::nullopt;
  const char* const name = isCylindrical ? "Cylinder" : "Axes";
  const auto [a, b] = entry.vectors(name);
  const Eigen::Vector3d first = Eigen::Map<const Eigen::Vector3d>(a.data()),
                        second = Eigen::Map<const Eigen::Vector3d>(b.data());
  if (isCylindrical ? first == second : first.cross(second).norm() <= 1e-9 * first.norm() * second.norm())
    entry.refuseValue(name, isCylindrical ? "that is one point" : "that is one direction");
  fem::LocalAxes axes{isCylindrical, a, b};
  const Eigen::Vector3d third = axesAt(axes, {1, 2, 3}).col(2);
  if (dimension == 2 && std::abs(third[2]) < 1 - 1e-9)
    entry.refuseValue(name, "the third axis must be across the plane of the body");
  return axes;
}

/// The components of an elastic body, or its normal.
void readComponents(const ListReader& entry, const Body& body, fem::SolidSupport& support) {
  entry.refuseGiven({"Value"}, "the components \"X\", \"Y\" and \"Z\" say what is held of an elastic body");
  if (dimensionOf(body) == 2)
    entry.refuseGiven({"Z"}, "the body lies in the plane");
  for (int c = 0; c < componentsOf(body.physics); ++c)
    if (const std::string component(1, "XYZ"[c]); entry.has(component))
      support.value[c] = entry.real(component);
  support.axes = readAxes(entry, dimensionOf(body));
  if (entry.has("Normal"))
    support.normal = entry.real("Normal");
  if (!support.normal && std::none_of(support.value.begin(), support.value.end(),
                                      [](const auto& value) { return value.has_value(); }))
    entry.refuseList("holds nothing; give at least one of the components that it prescribes, \"X\", \"Y\"" +
                     std::string(dimensionOf(body) == 3 ? ", \"Z\"" : "") + ", or \"Normal\"");
}

std::vector<fem::SolidSupport> readSupports(const ListReader& list, const Body& body) {
  std::vector<fem::SolidSupport> supports;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    fem::SolidSupport support{name, "", {}, {}};
    if (isElastic(body) || !body.mesh.file.empty()) {
      entry.refuseGiven({"Edge"}, "only membranes on rectangles have edges; name the \"Surface\"");
      entry.require("Surface");
      support.surface = entry.word("Surface");
    } else {
      entry.refuseGiven({"Surface"}, "a membrane on a rectangle is supported on an \"Edge\"");
      entry.require("Edge");
      support.surface = entry.edge("Edge");
    }
    if (isElastic(body)) {
      readComponents(entry, body, support);
    } else {
      entry.refuseGiven({"X", "Y", "Z", "Normal", "Axes", "Cylinder"},
                        "a membrane's deflection is its \"Value\"");
      support.value[0] = entry.real("Value");
      if (isMembraneOnRectangle(body))
        requireAgreement(entry, support, supports);
    }
    supports.push_back(support);
  }
  return supports;
}

/// Where a distributed force acts, and its moment.
void readMoment(const ListReader& list, const Body& body, fem::SolidLoad& load) {
  if (isOfRevolution(body))
    list.refuseGiven({"Moment", "Point"}, "a solid of revolution is loaded along its axis alone");
  load.atCentre = !list.hasEntries("Point");
  if (!load.atCentre)
    load.point = list.vector("Point", dimensionOf(body));
  if (!list.hasEntries("Moment"))
    return;
  if (dimensionOf(body) == 3)
    load.moment = list.vector("Moment", 3);
  else if (list.length("Moment") == 1)
    load.moment[2] = list.reals("Moment").front();
  else
    list.refuseValue("Moment", "of a plane body it is one number, {m}, counter-clockwise");
}

/// Where a load acts; the parameters of the other kinds are refused.
void readPlace(const ListReader& list, const Body& body, fem::SolidLoad& load) {
  const std::string reason = "a load of the kind \"" + list.word("Kind") + "\" has no use for it";
  using Kind = fem::SolidLoad::Kind;
  if (load.kind != Kind::body)
    list.refuseGiven({"Box"}, reason);
  if (load.kind != Kind::body && load.kind != Kind::rotation)
    list.refuseGiven({"Group"}, reason);
  if (load.kind == Kind::body || load.kind == Kind::rotation)
    list.refuseGiven({"Surface"}, reason);
  if (load.kind != Kind::point && load.kind != Kind::rotation && load.kind != Kind::distributed)
    list.refuseGiven({"Point"}, reason);
  if (load.kind != Kind::distributed)
    list.refuseGiven({"Moment"}, reason);
  if (load.kind == Kind::rotation && isOfRevolution(body)) {
    list.refuseGiven({"Point"}, "a solid of revolution turns about its axis, x = 0");
    load.axis = {0, 1, 0};
  }
  if (load.kind != Kind::rotation || dimensionOf(body) == 2)
    list.refuseGiven({"Axis"}, reason);
  if (load.kind == Kind::body) {
    requireOneDomain(list, body.mesh);
    load.where = list.word("Group");
    if (list.hasEntries("Box"))
      load.box = boxIn(list, body);
    load.wholeElements = !isMembraneOnRectangle(body);
  } else if (load.kind == Kind::rotation) {
    load.where = list.word("Group");
    if (list.hasEntries("Point"))
      load.point = list.vector("Point", dimensionOf(body));
    if (dimensionOf(body) == 3) {
      list.require("Axis", " of a load of the kind \"rotation\" in space");
      load.axis = list.vector("Axis", 3);
      if (load.axis == Vector3{0, 0, 0})
        list.refuseValue("Axis", "that is no direction");
    }
  } else if (load.kind == Kind::point && list.hasEntries("Surface")) {
    list.refuseGiven({"Point"}, "there is a \"Surface\", too; give one of them");
    load.where = list.word("Surface");
  } else if (load.kind == Kind::point) {
    list.require("Point", " of a load of the kind \"point\" without a \"Surface\"");
    load.point = list.vector("Point", dimensionOf(body));
  } else {
    if (load.kind != Kind::temperature)
      list.require("Surface");
    load.where = list.word("Surface");
    if (load.kind == Kind::distributed)
      readMoment(list, body, load);
  }
}

fem::SolidLoad::Kind kindOf(const std::string& word) {
  using Kind = fem::SolidLoad::Kind;
  return word == "body"          ? Kind::body
         : word == "traction"    ? Kind::traction
         : word == "pressure"    ? Kind::pressure
         : word == "rotation"    ? Kind::rotation
         : word == "point"       ? Kind::point
         : word == "distributed" ? Kind::distributed
                                 : Kind::temperature;
}

std::vector<fem::SolidLoad> readLoads(const ListReader& list, const Body& body) {
  std::vector<fem::SolidLoad> loads;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    fem::SolidLoad load;
    load.name = name;
    load.kind = kindOf(entry.word("Kind"));
    if (load.kind != fem::SolidLoad::Kind::body && isMembraneOnRectangle(body))
      entry.refuseValue("Kind", "a membrane on a rectangle carries loads of the kind \"body\" only");
    if (load.kind == fem::SolidLoad::Kind::pressure && !isElastic(body))
      entry.refuseValue("Kind", "membranes carry no pressure on their edges; give a traction");
    if (load.kind == fem::SolidLoad::Kind::rotation && !isElastic(body))
      entry.refuseValue("Kind", "membranes do not turn");
    if (load.kind == fem::SolidLoad::Kind::temperature && !isElastic(body))
      entry.refuseValue("Kind", "membranes do not expand");
    if (load.kind == fem::SolidLoad::Kind::distributed && !isElastic(body))
      entry.refuseValue("Kind", "membranes carry no moments; give a traction");
    readPlace(entry, body, load);
    if (!isElastic(body) || load.kind == fem::SolidLoad::Kind::pressure ||
        load.kind == fem::SolidLoad::Kind::rotation || load.kind == fem::SolidLoad::Kind::temperature) {
      entry.refuseGiven({"Force"}, "a load of this kind is a number, its \"Value\"");
      entry.require("Value");
      load.value[0] = entry.real("Value");
    } else {
      entry.refuseGiven({"Value"}, "a load of this kind has components, its \"Force\"");
      entry.require("Force");
      load.value = entry.vector("Force", dimensionOf(body));
      if (load.kind == fem::SolidLoad::Kind::distributed && isOfRevolution(body) && load.value[0] != 0)
        entry.refuseValue("Force", "a solid of revolution is loaded along its axis alone, {0, F}");
    }
    loads.push_back(load);
  }
  return loads;
}

} // namespace

Body readBody(const std::string& name, const ListReader& list) {
  Body body;
  body.name = name;
  body.physics = physicsOf(list.word("Physics"));
  body.mesh = readMesh(list, dimensionOf(body));
  body.reducedIntegration = list.word("Integration") == "reduced";
  if (!isOfRevolution(body))
    list.refuseGiven({"Axis"}, "only axisymmetric bodies have one");
  body.holdsAxis = list.word("Axis") == "held";
  body.material = readMaterial(list, body.physics, {}, false);
  body.regions = readRegions(list.inside("Regions"), body);
  body.stiffnessFactors = readStiffnessFactors(list.inside("Stiffness Factors"), body.physics);
  body.supports = readSupports(list.inside("Supports"), body);
  body.loads = readLoads(list.inside("Loads"), body);
  body.decomposition = readDecomposition(list.inside("Decomposition"), name, body.mesh, dimensionOf(body));
  return body;
}

} // namespace epafi::scene
