#include "epafi/scene/MaterialReader.hpp"

#include "epafi/fem/HookesLaw.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace epafi::scene {
namespace {

/// Axis 1 along the first of two vectors, axis 2 in their plane.
Eigen::Matrix3d axesIn(const ListReader& list) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (!list.hasEntries("Axes"))
    return axes;
  const std::vector<double> values = list.reals("Axes");
  if (values.size() != 6)
    list.refuseValue("Axes",
                     "must have 6 entries {ax, ay, az, bx, by, bz}, not " + std::to_string(values.size()));
  const Eigen::Vector3d a = Eigen::Vector3d::Map(values.data()), b = Eigen::Vector3d::Map(values.data() + 3),
                        normal = a.cross(b);
  constexpr double sameDirection = 1e-6;
  if (!(normal.norm() > sameDirection * a.norm() * b.norm()))
    list.refuseValue("Axes", "its vectors {ax, ay, az} and {bx, by, bz} must not be 0, nor lie in one line");
  axes.col(0) = a.normalized();
  axes.col(2) = normal.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// Of a material that is not isotropic.
fem::ElasticityMatrix elasticityIn(const ListReader& list) {
  list.refuseGiven({"Young's Modulus", "Poisson's Ratio"},
                   "its \"Elasticity\" says all of that; remove one of them");
  const std::vector<double> constants = list.reals("Elasticity");
  if (constants.size() != 9 && constants.size() != 21)
    list.refuseValue("Elasticity",
                     "must have 9 entries (orthotropic) or 21, not " + std::to_string(constants.size()));
  const fem::ElasticityMatrix elasticity = fem::elasticityOf(constants, axesIn(list));
  if (!fem::isPositiveDefinite(elasticity))
    list.refuseValue("Elasticity",
                     "a material with these constants gives way by itself: they must be positive "
                     "definite");
  return elasticity;
}

} // namespace

fem::Material readMaterial(const ListReader& list, fem::Physics physics, const fem::Material& outer,
                           bool isRegion) {
  fem::Material material = outer;
  const auto take = [&](const char* name, double& value) {
    if (list.has(name))
      value = list.positive(name);
  };
  if (physics == fem::Physics::membrane) {
    list.refuseGiven({"Young's Modulus", "Poisson's Ratio", "Thickness", "Expansion", "Elasticity", "Axes"},
                     "membranes have none; remove it");
    take("Conductivity", material.conductivity);
    return material;
  }
  const std::string useless = "bodies of the physics \"" + toString(physics) + "\" have none; remove it";
  list.refuseGiven({"Conductivity"}, useless);
  if (physics == fem::Physics::elasticity3d || physics == fem::Physics::axisymmetric)
    list.refuseGiven({"Thickness"}, useless);
  take("Thickness", material.thickness);
  if (list.has("Expansion"))
    material.expansion = list.real("Expansion");
  if (list.hasEntries("Elasticity")) {
    material.elasticity = elasticityIn(list);
    if (physics == fem::Physics::axisymmetric &&
        !material.elasticity->topRightCorner<4, 2>().isZero(1e-9 * material.elasticity->trace()))
      list.refuseValue("Elasticity", "a solid of revolution of this material would twist; axis 3 must be "
                                     "around the body, a plane of symmetry across it");
    return material;
  }
  list.refuseGiven({"Axes"}, "there is no \"Elasticity\" beside it that they could turn");
  const bool isGiven = list.has("Young's Modulus") || list.has("Poisson's Ratio");
  if (!isRegion || (outer.elasticity && isGiven)) // a law is given as a whole
    for (const char* const name : {"Young's Modulus", "Poisson's Ratio"})
      list.require(name, " of an elastic body without \"Elasticity\"");
  if (isGiven)
    material.elasticity.reset();
  take("Young's Modulus", material.youngsModulus);
  if (list.has("Poisson's Ratio"))
    material.poissonsRatio = list.real("Poisson's Ratio");
  return material;
}

std::vector<fem::StiffnessFactor> readStiffnessFactors(const ListReader& list, fem::Physics physics) {
  std::vector<fem::StiffnessFactor> factors;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    if (physics == fem::Physics::membrane)
      entry.refuseList("is of an elastic body; give a membrane regions of another \"Conductivity\"");
    factors.push_back({name, entry.word("Surface"), entry.positive("Value")});
  }
  return factors;
}

} // namespace epafi::scene
