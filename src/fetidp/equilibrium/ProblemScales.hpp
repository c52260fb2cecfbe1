#pragma once

/// By what the quantities of a problem are measured wherever something is decided by them: what is exactly 0
/// in a scene along the axes is round-off in its turned copy, and decides the same. One scale for each kind
/// of quantity, none of them the difference that it measures.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/equilibrium/KernelConstraint.hpp"

#include <Eigen/Core>

#include <map>
#include <vector>

namespace epafi::fetidp {

/// Of one problem, as its loads, supports and rows are now. Motions are those of whole bodies, k of them,
/// each measured by the largest displacement that it makes: α = 1 moves a node by 1, whatever the modes'
/// scaling is.
class ProblemScales {
public:
  /// A resultant smaller than this part of the loads on its body counts as zero.
  static constexpr double resultant = 1e-9;
  /// A motion that a row hinders by less than this share of it, it does not hinder: that is round-off of
  /// normals.
  static constexpr double hindered = 1e-6;
  /// What forces, lengths and kernels keep of larger ones that cancelled.
  static constexpr double roundOff = 1e-12;

  /// Collective.
  ProblemScales(const decomposition::DecomposedProblem& problem, const decomposition::ProblemData& data);

  /// Largest displacement of each mode of the bodies, k; 1 for a mode without any.
  [[nodiscard]] const Eigen::VectorXd& motions() const { return motions_; }
  /// Loads on the body of each motion, k: the sum of all forces on it whatever their directions, those on
  /// supports, too. Where supports prescribe displacements, not less than what is left if the forces that
  /// these cause cancel; those on the least loaded body where a body carries none but round-off.
  [[nodiscard]] const Eigen::VectorXd& loads() const { return loads_; }
  /// The same for the columns of R, in their own scaling: what ẽ is measured by.
  [[nodiscard]] const Eigen::VectorXd& resultants() const { return resultants_; }
  /// Largest gap or prescribed displacement.
  [[nodiscard]] double length() const { return length_; }

  /// This rank's rows of G̃ᵀ of whole bodies, by local index in multiplierMap, for motions measured as here:
  /// those that hinder any.
  /// \param entries  see kernelConstraintOfBodies
  /// Not collective.
  [[nodiscard]] std::map<int, Eigen::VectorXd> hinderingRows(const std::vector<KernelEntry>& entries) const;
  /// Whether a row hinders motions, `row` being what motions of length 1 do to it. \param number local index
  /// in multiplierMap
  [[nodiscard]] bool hinders(int number, const Eigen::VectorXd& row) const {
    return row.norm() > hindered * rowSizes_[number];
  }

private:
  void measureMotions(const decomposition::DecomposedProblem& problem);
  void measureLoads(const decomposition::DecomposedProblem& problem, const decomposition::ProblemData& data);
  void measureRows(const decomposition::DecomposedProblem& problem);

  Eigen::VectorXd motions_, loads_, resultants_;
  double length_ = 0;
  std::vector<double> rowSizes_; ///< Σ|b| of this rank's rows
};

} // namespace epafi::fetidp
