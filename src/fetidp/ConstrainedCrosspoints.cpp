#include "epafi/fetidp/ConstrainedCrosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>

#include <utility>

namespace epafi::fetidp {
namespace {

/// This rank's rows of a multivector.
Eigen::MatrixXd localRows(const MultiVector& values) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(values.getLocalLength()),
                       static_cast<Eigen::Index>(values.getNumVectors()));
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    const auto column = values.getData(static_cast<std::size_t>(j));
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      rows(i, j) = column[i];
  }
  return rows;
}

} // namespace

ConstrainedCrosspoints::ConstrainedCrosspoints(const DeflatedDualOperator& deflated, const MultiVector& jumps,
                                               const MultiVector& atCrosspoints,
                                               const Eigen::MatrixXd& stiffness) {
  const Eigen::Index size = stiffness.rows();
  const Eigen::MatrixXd corners = localRows(atCrosspoints);
  Eigen::MatrixXd flexibility, caused; // Ŝ⁻¹, D⁰
  collectively(*jumps.getMap()->getComm(), [&] { flexibility = direct::inverseOfSpd(stiffness); });
  caused = (localRows(jumps) + corners) * flexibility;

  const DualColumnSpace& space = deflated.space();
  std::vector<AccurateSum> held(static_cast<std::size_t>(size * size)); // D⁰ᵀU(UᵀFU)⁻¹UᵀD⁰
  jumps_.resizeLike(caused);
  Vector column(jumps.getMap()), constrained(jumps.getMap());
  for (Eigen::Index j = 0; j < size; ++j) {
    const std::span<double> values = qp::localDataNonConst(column);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = caused(static_cast<Eigen::Index>(i), j);
    const Eigen::VectorXd& c = space.coefficients(column);
    space.subtractImage(c, column); // D = P_Uᵀ D⁰
    constrained.putScalar(0.0);
    space.add(c, 1.0, constrained); // U(UᵀFU)⁻¹UᵀD⁰
    const std::span<const double> projected = qp::localData(column), forces = qp::localData(constrained);
    for (std::size_t i = 0; i < projected.size(); ++i) {
      jumps_(static_cast<Eigen::Index>(i), j) = projected[i];
      for (Eigen::Index k = 0; forces[i] != 0 && k < size; ++k)
        held[static_cast<std::size_t>(k + j * size)].add(caused(static_cast<Eigen::Index>(i), k) * forces[i]);
    }
  }
  sumOverRanks(*jumps.getMap()->getComm(), held);
  for (Eigen::Index k = 0; k < size * size; ++k)
    flexibility.data()[k] -= held[static_cast<std::size_t>(k)].value();
  collectively(*jumps.getMap()->getComm(), [&] {
    stiffness_ = direct::inverseOfSpd((0.5 * (flexibility + flexibility.transpose())).eval());
  });
  jumps_ = (jumps_ * stiffness_ - corners).eval();
}

void ConstrainedCrosspoints::negativeJumps(const Eigen::MatrixXd& u, MultiVector& y) const {
  for (Eigen::Index column = 0; column < u.cols(); ++column) {
    const auto values = y.getDataNonConst(static_cast<std::size_t>(column));
    for (Eigen::Index i = 0; i < jumps_.rows(); ++i)
      values[i] = 0;
    for (Eigen::Index k = 0; k < jumps_.cols(); ++k) // entry by entry: the same on any number of ranks
      for (Eigen::Index i = 0; i < jumps_.rows(); ++i)
        values[i] -= jumps_(i, k) * u(k, column);
  }
}

void ConstrainedCrosspoints::subtractForces(const MultiVector& r, std::span<AccurateSum> sums) const {
  for (std::size_t column = 0; column < r.getNumVectors(); ++column) {
    const auto values = r.getData(column);
    for (Eigen::Index k = 0; k < jumps_.cols(); ++k)
      for (Eigen::Index i = 0; i < jumps_.rows(); ++i)
        sums[static_cast<std::size_t>(k) + column * static_cast<std::size_t>(jumps_.cols())].add(
            -jumps_(i, k) * values[i]);
  }
}

} // namespace epafi::fetidp
