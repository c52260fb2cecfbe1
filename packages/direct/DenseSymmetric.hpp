#pragma once

/// Dense symmetric positive definite matrices that condensation leaves, through LAPACK.

#include <Eigen/Core>

namespace epafi::direct {

/// C Cᵀ of a lower triangular C, k × k; both triangles of the result are equal to the last digit.
Eigen::MatrixXd productOfFactor(const Eigen::MatrixXd& lower);
/// (C Cᵀ)⁻¹, likewise. \throws Error if an entry of C's diagonal is 0.
Eigen::MatrixXd inverseFromFactor(Eigen::MatrixXd lower);
/// A⁻¹ of a symmetric positive definite A, of which the lower triangle is read. \throws Error if A is not.
Eigen::MatrixXd inverseOfSpd(Eigen::MatrixXd matrix);

} // namespace epafi::direct
