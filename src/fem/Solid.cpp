#include "epafi/fem/Solid.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <utility>

namespace epafi::fem {

namespace {

struct Entry {
  const char* name;
  int components, dimension;
};

const Entry& entryOf(Physics physics) {
  static constexpr std::array<Entry, 5> entries{{{"membrane", 1, 2}, // in the order of Physics
                                                 {"plane strain", 2, 2},
                                                 {"plane stress", 2, 2},
                                                 {"elasticity 3-D", 3, 3},
                                                 {"axisymmetric", 2, 2}}};
  return entries[static_cast<std::size_t>(physics)];
}

} // namespace

std::string toString(Physics physics) {
  return entryOf(physics).name;
}

int componentsOf(Physics physics) {
  return entryOf(physics).components;
}

int dimensionOf(Physics physics) {
  return entryOf(physics).dimension;
}

Eigen::Matrix3d axesAt(const LocalAxes& axes, const Point& point) {
  using Eigen::Vector3d;
  const Vector3d a = Eigen::Map<const Vector3d>(axes.a.data()), b = Eigen::Map<const Vector3d>(axes.b.data());
  Eigen::Matrix3d result;
  if (axes.isCylindrical) {
    const Vector3d along = (b - a).normalized();
    const Vector3d away = Eigen::Map<const Vector3d>(point.data()) - a;
    const Vector3d radius = away - away.dot(along) * along;
    const Vector3d first =
        radius.norm() > 1e-9 * (b - a).norm() ? Vector3d(radius.normalized()) : along.unitOrthogonal();
    result << first, along.cross(first), along;
  } else {
    const Vector3d first = a.normalized(), third = first.cross(b).normalized();
    result << first, third.cross(first), third;
  }
  return result;
}

bool isHeated(const Solid& body) {
  return std::any_of(body.loads.begin(), body.loads.end(), [](const SolidLoad& load) {
    return load.kind == SolidLoad::Kind::temperature && load.value[0] != 0;
  });
}

SolidLoad loadInside(std::string name, const mesh::Box& box, double value) {
  return {std::move(name), SolidLoad::Kind::body, box, "", {0, 0, 0}, {value, 0, 0}, false};
}

} // namespace epafi::fem
