#include "RandomScene.hpp"

#include "support/TurnedMesh.hpp"

#include <Teuchos_Array.hpp>

#include <fstream>
#include <string>

namespace epafi::test {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

Array<double> arrayOf(const Vector3& vector, int dimension) {
  return {vector.data(), vector.data() + dimension};
}

Array<double> boxOf(const Vector3& lower, const Vector3& upper, int dimension) {
  Array<double> box;
  for (int d = 0; d < dimension; ++d) {
    box.push_back(lower[d]);
    box.push_back(upper[d]);
  }
  return box;
}

std::string bodyName(int body) {
  return "body " + std::string(1, static_cast<char>('a' + body));
}

mesh::Box sceneBox(const DrawnBody& body) {
  return {{body.lower[0], body.lower[1], body.lower[2]}, {body.upper[0], body.upper[1], body.upper[2]}};
}

void writeMesh(const DrawnScene& scene, const DrawnBody& body, const std::string& path) {
  const mesh::StructuredMesh mesh(sceneBox(body), body.elements);
  std::ofstream(path) << epafi::test::fileOf(
      epafi::test::arraysOf(mesh, {scene.turn, scene.shift}, body.isSimplex));
}

void addMesh(const DrawnScene& scene, int number, const std::string& folder, ParameterList& list) {
  const DrawnBody& body = scene.bodies[number];
  list.set("Order", body.order);
  if (body.isFile) {
    const std::string file = std::string(1, static_cast<char>('a' + number)) + ".msh";
    writeMesh(scene, body, folder + "/" + file);
    list.set("Mesh", file);
    return;
  }
  list.set(scene.dimension == 2 ? "Rectangle" : "Box", boxOf(body.lower, body.upper, scene.dimension));
  list.set("Elements", Array<int>(body.elements.begin(), body.elements.begin() + scene.dimension));
}

void addSupports(const DrawnScene& scene, const DrawnBody& body, ParameterList& list) {
  int number = 0;
  for (const DrawnSupport& support : body.supports) {
    ParameterList& entry = list.sublist("support " + std::to_string(++number));
    entry.set("Surface", support.surface);
    if (support.normal)
      entry.set("Normal", *support.normal);
    Vector3 value = Vector3::Zero();
    for (std::size_t d = 0; d < 3; ++d)
      value[d] = support.value[d].value_or(0.0);
    value = scene.turn * value;
    for (std::size_t d = 0; d < 3; ++d)
      if (support.value[d])
        entry.set(std::string(1, static_cast<char>('X' + d)), value[d]);
  }
}

void addLoads(const DrawnScene& scene, const DrawnBody& body, ParameterList& list) {
  int number = 0;
  for (const DrawnLoad& load : body.loads) {
    ParameterList& entry = list.sublist("load " + std::to_string(++number));
    entry.set("Kind", load.kind);
    if (load.kind == "traction" || load.kind == "pressure")
      entry.set("Surface", load.surface);
    if (load.kind == "pressure")
      entry.set("Value", load.force[0]);
    else
      entry.set("Force", arrayOf(scene.turn * load.force, scene.dimension));
    if (load.kind == "point")
      entry.set("Point", arrayOf(scene.turn * load.point + scene.shift, scene.dimension));
  }
}

void addBody(const DrawnScene& scene, int number, const std::string& folder, ParameterList& bodies) {
  const DrawnBody& body = scene.bodies[number];
  ParameterList& list = bodies.sublist(bodyName(number));
  list.set("Physics", scene.physics);
  addMesh(scene, number, folder, list);
  list.set("Young's Modulus", body.youngsModulus).set("Poisson's Ratio", body.poissonsRatio);
  int region = 0;
  for (const DrawnRegion& drawn : body.regions)
    list.sublist("Regions")
        .sublist("region " + std::to_string(++region))
        .set("Box", boxOf(drawn.lower, drawn.upper, scene.dimension))
        .set("Young's Modulus", drawn.youngsModulus);
  if (!body.supports.empty())
    addSupports(scene, body, list.sublist("Supports"));
  if (!body.loads.empty())
    addLoads(scene, body, list.sublist("Loads"));
  ParameterList& cut = list.sublist("Decomposition");
  cut.set("Method", body.cut.isGrid ? "grid" : "metis").set("Cluster", body.cut.cluster);
  if (body.cut.isGrid)
    cut.set("Grid", Array<int>(body.cut.counts.begin(), body.cut.counts.begin() + scene.dimension));
  else
    cut.set("Parts", body.cut.parts);
}

void addContact(const DrawnScene& scene, const DrawnContact& contact, const std::string& name,
                ParameterList& list) {
  ParameterList& entry = list.sublist("Contact").sublist(name);
  entry.set("First Body", bodyName(contact.first)).set("First Surface", contact.firstSurface);
  if (!contact.isTied)
    entry.set("Gap", contact.gap);
  else
    entry.set("Kind", "tied");
  if (contact.second >= 0) {
    entry.set("Second Body", bodyName(contact.second)).set("Second Surface", contact.secondSurface);
    entry.set("Coupling", contact.coupling);
    if (contact.coupling == "mortar")
      entry.set("Multipliers", contact.multipliers);
    return;
  }
  entry.set("Obstacle", name);
  ParameterList& obstacle = list.sublist("Obstacles").sublist(name);
  obstacle.set("Point", arrayOf(scene.turn * contact.point + scene.shift, scene.dimension));
  if (contact.radius > 0)
    obstacle.set("Kind", scene.dimension == 2 ? "circle" : "sphere").set("Radius", contact.radius);
  else
    obstacle.set("Kind", "plane").set("Normal", arrayOf(scene.turn * contact.normal, scene.dimension));
}

} // namespace

ParameterList listOf(const DrawnScene& scene, const std::string& folder) {
  ParameterList list("Epafi");
  for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body)
    addBody(scene, body, folder, list.sublist("Bodies"));
  int number = 0;
  for (const DrawnContact& contact : scene.contacts)
    addContact(scene, contact, "contact " + std::to_string(++number), list);
  list.sublist("Solver").setParameters(scene.solver);
  return list;
}

} // namespace epafi::test
