#pragma once

/// A solver of contact with friction that shares no line with Epafi's: whole bodies condensed to their
/// contacts by dense factors, an alternating projection, then semismooth Newton on all nodes.

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace epafi::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of a node with friction: forces and motions are (normal, tangents).
struct NodeLaw {
  double bound = 0, coefficient = 0;
  [[nodiscard]] double at(double normal) const { return bound + coefficient * std::max(0.0, normal); }
};

/// The whole problem, on every rank.
struct Whole {
  Index components = 0;
  MatrixXd stiffness, rows; ///< K; of each node of contact its normal and tangents
  VectorXd load, gap, prescribed;
  std::vector<bool> isHeld;
  std::vector<int> body; ///< of each unknown
  MatrixXd places;       ///< of each unknown
  std::vector<NodeLaw> laws;
};

/// Contact with friction, condensed: w = d − Fλ + Gᵀα, Gλ = e.
class Condensed {
public:
  explicit Condensed(const Whole& whole);

  /// What forces within friction's bounds miss of the loads' resultant, at least, relative to it; with
  /// Coulomb's law any normal force may hold.
  [[nodiscard]] double missing() const;

  /// Forces and motions; whether the natural residual is small is for the caller to see.
  bool solve();

  [[nodiscard]] VectorXd slip(const VectorXd& force, const VectorXd& motion) const {
    return offset_ - flexibility_ * force + motions_ * motion;
  }
  [[nodiscard]] VectorXd slip() const { return slip(force_, motion_); }
  [[nodiscard]] const VectorXd& force() const { return force_; }
  [[nodiscard]] const VectorXd& stiffness() const { return stiffness_; }
  [[nodiscard]] bool floats() const { return resultant_.size() > 0; }
  [[nodiscard]] bool isIdle(Index row) const { return isIdle_[static_cast<std::size_t>(row)]; }
  /// That of forces and the slips w beside them, relative to the largest of both: how far they are from each
  /// other's law, as forces.
  [[nodiscard]] double residual(const VectorXd& force, const VectorXd& slip) const {
    const VectorXd augmented = force + stiffness_.cwiseProduct(slip);
    return (force - withinBounds(augmented)).lpNorm<Eigen::Infinity>() / scaleOf(force);
  }
  [[nodiscard]] double scaleOf(const VectorXd& force) const {
    return std::max({force.lpNorm<Eigen::Infinity>(), 1e-6 * whole_.load.lpNorm<Eigen::Infinity>(), 1e-12});
  }
  [[nodiscard]] VectorXd displacement() const;

private:
  struct Part {
    std::vector<Index> unknowns;
    MatrixXd kernel; ///< orthonormal
    Eigen::LLT<MatrixXd> factor;
    VectorXd load;
  };

  /// Rigid motions that the supports of a body allow.
  [[nodiscard]] MatrixXd kernelOf(int b, const std::vector<Index>& unknowns) const;

  /// Each node's normal force at least 0, then its tangential one in the disc of that.
  [[nodiscard]] VectorXd withinBounds(VectorXd x) const;

  /// The nearest forces with |λ_t| ≤ g + μ λ_n, λ_n ≥ 0.
  [[nodiscard]] VectorXd ontoCones(VectorXd x) const;

  /// Φ of Alart and Curnier and its derivative. \param rho stiffness of each row
  VectorXd equations(const VectorXd& rho, MatrixXd* derivative) const;

  bool newton(double factorOfStiffness);

  const Whole& whole_;
  std::vector<Part> parts_;
  MatrixXd flexibility_, motions_; ///< F, Gᵀ
  VectorXd offset_, resultant_;    ///< d, e
  VectorXd stiffness_;             ///< about 1/F_ii, the same in all rows of a node
  std::vector<bool> isIdle_;       ///< rows that touch no unknown
  VectorXd force_, motion_;        ///< λ, α
};

} // namespace epafi::test
