#include "MeasuredSystem.hpp"

#include "Cones.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace epafi::test {
namespace {

/// The size of all loads on bodies of some size, those that supports carry at once included.
double nominalLoad(const scene::Scene& scene, double size) {
  using Kind = fem::SolidLoad::Kind;
  double sum = 0;
  for (const scene::Body& body : scene.bodies)
    for (const fem::SolidLoad& load : body.loads) {
      const int extent = dimensionOf(body.physics) - (load.kind == Kind::body ? 0 : 1);
      sum += std::hypot(load.value[0], load.value[1], load.value[2]) *
             (load.kind == Kind::point ? 1.0 : std::pow(size, extent));
    }
  return sum;
}

} // namespace

Measured::Measured(drivers::UndecomposedSystem given, const scene::Scene& scene)
    : system(std::move(given)), rows(system.constraint) {
  size = (system.place.rowwise().maxCoeff() - system.place.rowwise().minCoeff()).norm();
  lengths = rows.rowwise().norm();
  gap = system.gap;
  constexpr double shortest = 1e-6; // that a row has which supports do not hold whole
  const double longest = std::max(shortest, lengths.size() > 0 ? lengths.maxCoeff() : 0);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (std::abs(gap[i]) < 1e-12 * longest * (size + system.place.cwiseAbs().maxCoeff()))
      gap[i] = 0;
    if (lengths[i] > roundOff * longest) {
      if (lengths[i] < 1e-3 * longest)
        throw Uncertain{"a row that supports nearly hold"};
      rows.row(i) /= lengths[i];
      gap[i] /= lengths[i];
    } else {
      rows.row(i).setZero();
      lengths[i] = 1;
    }
  }
  gapScale = gap.size() > 0 ? gap.cwiseAbs().maxCoeff() : 0;
  loadScale = std::max(system.load.cwiseAbs().sum(), nominalLoad(scene, size));
  findMotions();
}

/// Among the rigid motions of each body, those that K does not resist.
void Measured::findMotions() {
  const Eigen::Index n = system.load.size();
  const Eigen::VectorXd diagonal = system.stiffness.diagonal();
  motion.resize(n, 0);
  const int bodies = n > 0 ? *std::max_element(system.body.begin(), system.body.end()) + 1 : 0;
  for (int body = 0; body < bodies; ++body) {
    Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(n, 6);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double count = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      if (system.body[i] == body) {
        centre += system.place.col(i);
        ++count;
      }
    if (count == 0)
      continue;
    centre /= count;
    for (Eigen::Index i = 0; i < n; ++i)
      if (system.body[i] == body) {
        const Eigen::Vector3d direction = system.direction.col(i),
                              arm = (system.place.col(i) - centre) / size;
        rigid.row(i) << direction.transpose(), arm.cross(direction).transpose();
      }
    if (system.components == 1)
      rigid = rigid.leftCols(1).eval();
    else if (system.components == 2)
      rigid = rigid(allOf, std::array{0, 1, 5}).eval();
    // Where supports hold much, motions of what is free may be multiples of each other.
    const auto [sizes, motions] = direct::rightSingularOf(rigid);
    Eigen::Index rank = 0;
    while (rank < sizes.size() && isClear(sizes[rank] / sizes[0], "motions of what is free"))
      ++rank;
    rigid =
        rigid * motions.leftCols(rank) * (std::sqrt(count) * sizes.head(rank).cwiseInverse()).asDiagonal();
    const Eigen::MatrixXd image = diagonal.cwiseInverse().asDiagonal() * (system.stiffness * rigid);
    const Eigen::MatrixXd free = rigid * nullSpace(image, "motions that supports leave");
    motion.conservativeResize(Eigen::NoChange, motion.cols() + free.cols());
    motion.rightCols(free.cols()) = free;
  }
}

} // namespace epafi::test
