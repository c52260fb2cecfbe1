#pragma once

/// Small questions of linear algebra and of cones that have an answer only where it is certain: numbers
/// between "zero" and "not zero" make it uncertain.

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace epafi::test {

/// What is below it, beside what it is measured by, is round-off; what is above `clear` is not.
inline constexpr double roundOff = 1e-10, clear = 1e-5;

/// Thrown where a number lies between the two: a scene on the border between two verdicts.
struct Uncertain {
  const char* of;
};

/// Whether a number ≥ 0 is not zero. \throws Uncertain
bool isClear(double value, const char* of);

/// Orthonormal basis of {x : Mx = 0}, M with entries of about 1. \throws Uncertain
Eigen::MatrixXd nullSpace(const Eigen::MatrixXd& matrix, const char* of);

/// What no x ≥ 0 makes of `target`: target − Ax of least length (Lawson, Hanson).
Eigen::VectorXd imbalance(const Eigen::MatrixXd& a, const Eigen::VectorXd& target);

/// Whether there is x with Cx ≤ s in the first rows and Cx = s in those from `numInequalities` on. Rows of
/// length 1 and s of about 1 at most. \throws Uncertain
bool isFeasible(const Eigen::MatrixXd& c, const Eigen::VectorXd& s, Eigen::Index numInequalities);

/// Whether x = 0 alone satisfies Ax ≤ 0 and Ex = 0. Rows of length 1 or less. \throws Uncertain
bool isPointed(const Eigen::MatrixXd& a, const Eigen::MatrixXd& e);

} // namespace epafi::test
