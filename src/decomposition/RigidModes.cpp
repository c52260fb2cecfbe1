#include "epafi/decomposition/RigidModes.hpp"

#include "epafi/direct/DenseOrthogonal.hpp"

#include <cmath>
#include <limits>

namespace epafi::decomposition {
namespace {

/// R of the QR factorisation of rows that come one by one: singular values to round-off, which those of a
/// Gram matrix would have to half the digits only.
class RowFactor {
public:
  explicit RowFactor(Eigen::Index columns) : rows_(Eigen::MatrixXd::Zero(columns + chunk, columns)) {}

  void add(const Eigen::VectorXd& row) {
    rows_.row(rows_.cols() + numNew_) = row.transpose();
    if (++numNew_ == chunk)
      compress();
  }
  [[nodiscard]] Eigen::MatrixXd factor() {
    compress();
    return rows_.topRows(rows_.cols());
  }

private:
  static constexpr Eigen::Index chunk = 64;

  void compress() {
    const Eigen::MatrixXd upper = direct::triangularFactor(rows_);
    rows_.setZero();
    rows_.topRows(rows_.cols()) = upper;
    numNew_ = 0;
  }

  Eigen::MatrixXd rows_; ///< R, and below it the rows since
  Eigen::Index numNew_ = 0;
};

} // namespace

Eigen::VectorXd RigidModes::at(const Point& point, int component) const {
  Eigen::VectorXd modes = Eigen::VectorXd::Zero(number());
  if (isOfRevolution_) {
    modes[0] = component == 1 ? 1 : 0;
    return modes;
  }
  modes[component] = 1;
  const auto x = [&](std::size_t d) { return (point[d] - centre_[d]) / size_; };
  if (components_ == 2)
    modes[2] = component == 0 ? -x(1) : x(0);
  if (components_ == 3) {
    // Rotation about axis a moves a point by e_a × x.
    const int next = (component + 1) % 3, last = (component + 2) % 3;
    modes[3 + next] = x(last);
    modes[3 + last] = -x(next);
  }
  return modes;
}

Eigen::VectorXd RigidModes::along(const Point& point, const Eigen::Vector3d& direction) const {
  Eigen::VectorXd modes = Eigen::VectorXd::Zero(number());
  for (int c = 0; c < components_; ++c)
    if (direction[c] != 0)
      modes += direction[c] * at(point, c);
  return modes;
}

FreeModes RigidModes::freeOf(std::span<const HeldDirection> held) const {
  if (held.empty())
    return {Eigen::MatrixXd::Identity(number(), number()), std::numeric_limits<double>::infinity()};
  RowFactor rows(number());
  for (const HeldDirection& value : held)
    rows.add(along(value.point, value.direction));
  const direct::RightSingular svd = direct::rightSingularOf(rows.factor());
  const Eigen::VectorXd hold = svd.values / std::sqrt(static_cast<double>(held.size()));
  Eigen::Index numHeld = 0;
  while (numHeld < hold.size() && hold[numHeld] > freeUpTo)
    ++numHeld;
  return {svd.vectors.rightCols(number() - numHeld),
          numHeld > 0 ? hold[numHeld - 1] : std::numeric_limits<double>::infinity()};
}

Eigen::MatrixXd RigidModes::twists() const {
  Eigen::MatrixXd twists = Eigen::MatrixXd::Zero(6, number());
  if (isOfRevolution_) {
    twists(1, 0) = 1;
  } else if (components_ == 2) {
    twists(0, 0) = twists(1, 1) = 1;
    twists(5, 2) = 1 / size_;
  } else if (components_ == 3) {
    twists.diagonal() << 1, 1, 1, 1 / size_, 1 / size_, 1 / size_;
  }
  return twists;
}

} // namespace epafi::decomposition
