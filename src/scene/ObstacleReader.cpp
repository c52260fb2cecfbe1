#include "epafi/scene/ObstacleReader.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::scene {
namespace {

/// The vector, divided by its length.
Vector3 direction(const ListReader& list, const std::string& name, int dimension) {
  Vector3 vector = list.vector(name, dimension);
  const double length = std::hypot(vector[0], vector[1], vector[2]);
  if (length == 0)
    list.refuseValue(name, "must have a direction");
  for (double& component : vector)
    component /= length;
  return vector;
}

NamedObstacle readObstacle(const std::string& name, const ListReader& list) {
  NamedObstacle result;
  result.name = name;
  const std::string& kind = list.word("Kind");
  const std::string useless = "an obstacle of the kind \"" + kind + "\" has no use for it";
  result.dimension = kind == "plane" ? std::clamp(list.length("Point"), 2, 3) : kind == "circle" ? 2 : 3;
  if (kind == "sphere" && list.length("Point") == 2)
    list.refuseValue("Kind", "a centre of two coordinates is that of a \"circle\"");
  result.obstacle.point = list.vector("Point", result.dimension);
  if (kind == "plane") {
    list.refuseGiven({"Radius"}, useless);
    list.require("Normal", " of a plane");
    result.obstacle.kind = Obstacle::Kind::plane;
    result.obstacle.normal = direction(list, "Normal", result.dimension);
  } else {
    list.refuseGiven({"Normal"}, useless);
    list.require("Radius", " of a " + kind);
    result.obstacle.kind = Obstacle::Kind::sphere;
    result.obstacle.radius = list.positive("Radius");
  }
  return result;
}

} // namespace

std::vector<NamedObstacle> readObstacles(const ListReader& list) {
  std::vector<NamedObstacle> obstacles;
  for (const std::string& name : list.names())
    obstacles.push_back(readObstacle(name, list.inside(name)));
  return obstacles;
}

} // namespace epafi::scene
