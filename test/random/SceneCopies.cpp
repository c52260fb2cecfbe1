#include "RandomNumbers.hpp"
#include "RandomScene.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace epafi::test {

DrawnScene inUnits(DrawnScene scene, const Units& units) {
  const double length = units.length, displacement = units.length * units.load,
               pressure = units.stiffness * units.load;
  scene.shift *= length;
  for (DrawnBody& body : scene.bodies) {
    body.lower *= length;
    body.upper *= length;
    body.youngsModulus *= units.stiffness;
    for (DrawnRegion& region : body.regions) {
      region.lower *= length;
      region.upper *= length;
      region.youngsModulus *= units.stiffness;
    }
    for (DrawnSupport& support : body.supports) {
      for (auto& value : support.value)
        value = value ? std::optional(*value * displacement) : value;
      support.normal = support.normal ? std::optional(*support.normal * displacement) : support.normal;
    }
    for (DrawnLoad& load : body.loads) {
      load.point *= length;
      load.force *= pressure * (load.kind == "body"    ? 1 / length
                                : load.kind == "point" ? std::pow(length, scene.dimension - 1)
                                                       : 1.0);
    }
  }
  for (DrawnContact& contact : scene.contacts) {
    contact.gap *= displacement;
    contact.point *= length;
    contact.radius *= length;
  }
  return scene;
}

DrawnScene movedTo(DrawnScene scene, double angle, double distance) {
  const Vector3 axis = scene.dimension == 2 ? Vector3(0, 0, 1) : Vector3(1, 2, -0.5).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  scene.turn = turn * scene.turn;
  const double size = (scene.bodies.back().upper - scene.bodies.front().lower).norm();
  scene.shift = turn * scene.shift +
                distance * size * Vector3(0.6, -0.8, scene.dimension == 3 ? 0.5 : 0.0).normalized();
  for (DrawnBody& body : scene.bodies)
    body.isFile = true;
  return scene;
}

void drawCuts(DrawnScene& scene, std::uint64_t seed) {
  RandomNumbers random(seed);
  const int cluster = random.chance(0.6) ? -1 : random.index(3);
  for (DrawnBody& body : scene.bodies) {
    body.cut.isGrid = !body.isFile && random.chance(0.6);
    for (int d = 0; d < scene.dimension; ++d) {
      const std::size_t axis = d;
      body.cut.counts[axis] = 1 + random.index(std::min(body.elements[axis], 2));
    }
    int elements = 1;
    for (int d = 0; d < scene.dimension; ++d)
      elements *= body.elements[d];
    body.cut.parts = 1 + random.index(std::min(elements, 4));
    body.cut.cluster = cluster;
  }
}

void drawSolver(DrawnScene& scene, std::uint64_t seed) {
  RandomNumbers random(seed);
  scene.solver = Teuchos::ParameterList("Solver");
  scene.solver.set("Tolerance", 1e-9).set("Equilibrium Tolerance", 1e-9);
  scene.solver.sublist("MPRGP").set("Time Limit", 20.0);
  if (random.chance(0.5)) // the defaults
    return;
  scene.solver.set("Algorithm", std::string(random.oneOf({"auto", "MPRGP", "active set"})));
  scene.solver.sublist("Preconditioner")
      .set("Type", std::string(random.oneOf({"dirichlet", "dirichlet", "lumped", "none"})))
      .set("Scaling", std::string(random.oneOf({"stiffness", "stiffness", "multiplicity"})));
  scene.solver.sublist("Adaptive Constraints")
      .set("Use", std::string(random.oneOf({"auto", "auto", "yes", "no"})));
  scene.solver.sublist("Dual Operator")
      .set("Mode", std::string(random.oneOf({"auto", "implicit", "explicit"})));
  scene.solver.sublist("Direct Solvers")
      .set("Subdomains", std::string(random.oneOf({"auto", "auto", "KLU2"})));
}

} // namespace epafi::test
