#include "epafi/fetidp/precondition/ConstrainedCrosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <vector>

namespace epafi::fetidp {
namespace {

using Rows = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// This rank's rows.
Rows rowsOf(MultiVector& values) {
  const auto view = values.getLocalViewHost(Tpetra::Access::ReadWrite);
  return Rows(view.data(), view.extent(0), view.extent(1), Eigen::OuterStride<>(view.stride(1)));
}

} // namespace

ConstrainedCrosspoints::ConstrainedCrosspoints(const qp::ColumnSpace& space, const MultiVector& jumps,
                                               const MultiVector& atCrosspoints,
                                               const Eigen::MatrixXd& stiffness) {
  const Comm& comm = *jumps.getMap()->getComm();
  const Eigen::Index size = stiffness.rows();
  MultiVector constrained(jumps, Teuchos::Copy), corners(atCrosspoints, Teuchos::Copy),
      held(jumps.getMap(), jumps.getNumVectors());
  constrained.update(1.0, corners, 1.0); // J + B_C
  Eigen::MatrixXd flexibility;           // Ŝ⁻¹
  collectively(comm, [&] { flexibility = direct::inverseOfSpd(stiffness); });
  const Eigen::MatrixXd caused = rowsOf(constrained) * flexibility; // D⁰
  rowsOf(constrained) = caused;
  qp::ColumnSpace::Coefficients c;
  space.coefficients(constrained, c);
  space.subtractImage(c, constrained); // D = P_Uᵀ D⁰
  space.addColumns(c, held);           // U(UᵀFU)⁻¹UᵀD⁰

  const auto forces = rowsOf(held);
  std::vector<AccurateSum> sums(size * size); // D⁰ᵀU(UᵀFU)⁻¹UᵀD⁰
  for (Eigen::Index j = 0; j < size; ++j)
    for (Eigen::Index i = 0; i < forces.rows(); ++i)
      for (Eigen::Index k = 0; forces(i, j) != 0 && k < size; ++k)
        sums[k + j * size].add(caused(i, k) * forces(i, j));
  sumOverRanks(comm, sums);
  for (Eigen::Index k = 0; k < size * size; ++k)
    flexibility.data()[k] -= sums[k].value();
  collectively(comm, [&] {
    stiffness_ = direct::inverseOfSpd((0.5 * (flexibility + flexibility.transpose())).eval());
  });
  jumps_ = rowsOf(constrained) * stiffness_ - rowsOf(corners);
}

void ConstrainedCrosspoints::negativeJumps(const Eigen::MatrixXd& u, MultiVector& y) const {
  for (Eigen::Index column = 0; column < u.cols(); ++column) {
    const auto values = y.getDataNonConst(column);
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
        sums[k + column * jumps_.cols()].add(-jumps_(i, k) * values[i]);
  }
}

} // namespace epafi::fetidp
