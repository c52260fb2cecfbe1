#include "epafi/fem/RigidModes.hpp"

#include <Eigen/Eigenvalues>

namespace epafi::fem {

Eigen::VectorXd RigidModes::at(const Point& point, int component) const {
  Eigen::VectorXd modes = Eigen::VectorXd::Zero(number());
  modes[component] = 1;
  const auto x = [&](std::size_t d) { return (point[d] - centre_[d]) / size_; };
  if (components_ == 2)
    modes[2] = component == 0 ? -x(1) : x(0);
  if (components_ == 3) {
    // Rotation about axis a moves a point by e_a × x.
    const int next = (component + 1) % 3, last = (component + 2) % 3;
    modes[3 + next] = x(static_cast<std::size_t>(last));
    modes[3 + last] = -x(static_cast<std::size_t>(next));
  }
  return modes;
}

Eigen::MatrixXd RigidModes::freeOf(std::span<const HeldComponent> held) const {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(number(), number());
  for (const HeldComponent& value : held) {
    const Eigen::VectorXd modes = at(value.point, value.component);
    gram += modes * modes.transpose();
  }
  if (held.empty())
    return Eigen::MatrixXd::Identity(number(), number());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  // A motion that moves no held node by more than 1e-7 of itself is free: points off a line by less are on it.
  constexpr double threshold = 1e-14;
  Eigen::Index numFree = 0;
  while (numFree < gram.rows() &&
         solver.eigenvalues()[numFree] <= threshold * static_cast<double>(held.size()))
    ++numFree;
  return solver.eigenvectors().leftCols(numFree);
}

} // namespace epafi::fem
