#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"

namespace epafi::decomposition {

void toNodalValues(const Subdomain& subdomain, Eigen::Ref<Eigen::VectorXd> u) {
  for (const Average& average : subdomain.averages) {
    const double mean = u[average.carrier];
    for (const int other : average.others) {
      u[average.carrier] -= u[other];
      u[other] += mean;
    }
  }
}

void toSpace(const Subdomain& subdomain, Eigen::Ref<Eigen::VectorXd> values) {
  if (subdomain.frames.empty())
    return;
  const Eigen::Index components = values.size() / std::ssize(subdomain.nodes);
  for (const NodeFrame& frame : subdomain.frames) {
    auto own = values.segment(frame.node * components, components);
    own = (frame.axes.topLeftCorner(components, components) * own).eval();
  }
}

Eigen::VectorXd atAllPositions(const Subdomain& subdomain, Eigen::VectorXd u, Eigen::VectorXd all) {
  toNodalValues(subdomain, u);
  all(subdomain.unknownPosition) = u;
  toSpace(subdomain, all);
  return all;
}

namespace {

/// From components in space, in place.
void toFrames(const Subdomain& subdomain, Eigen::VectorXd& values) {
  const Eigen::Index components = values.size() / std::ssize(subdomain.nodes);
  for (const NodeFrame& frame : subdomain.frames) {
    auto own = values.segment(frame.node * components, components);
    own = (frame.axes.topLeftCorner(components, components).transpose() * own).eval();
  }
}

} // namespace

Eigen::VectorXd loadOf(const Subdomain& subdomain, Eigen::VectorXd forces) {
  toFrames(subdomain, forces);
  return loadInBasisOf(subdomain.averages, forces(subdomain.unknownPosition));
}

Eigen::VectorXd heldPart(const Subdomain& subdomain, Eigen::VectorXd forces) {
  toFrames(subdomain, forces);
  forces(subdomain.unknownPosition).setZero();
  return forces;
}

Eigen::VectorXd unknownsOf(const Subdomain& subdomain, Eigen::VectorXd values) {
  toFrames(subdomain, values);
  Eigen::VectorXd u = values(subdomain.unknownPosition);
  for (const Average& average : subdomain.averages) {
    double mean = u[average.carrier];
    for (const int other : average.others)
      mean += u[other];
    mean /= static_cast<double>(average.others.size() + 1);
    u[average.carrier] = mean;
    for (const int other : average.others)
      u[other] -= mean;
  }
  return u;
}

} // namespace epafi::decomposition
