#include "epafi/fetidp/KernelFaceInverse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace epafi::fetidp {
namespace {

/// C of S = CCᵀ. \throws Error if S is not positive definite.
Eigen::MatrixXd factorOf(const Eigen::MatrixXd& stiffness) {
  std::optional<Eigen::MatrixXd> lower = direct::choleskyFactor(stiffness);
  if (!lower)
    throw Error(
        "the rows of G are linearly dependent: some rigid motion of the floating bodies meets no contact");
  return *std::move(lower);
}

/// K = S S_F⁻ S − S where S_F may be singular. With S = CCᵀ, W = C⁻¹S_F C⁻ᵀ has eigenvalues between 0 and 1, U those at 0, and
/// K = C(W⁻ − I)Cᵀ; the pseudo-inverse of W is changed by motions V = C⁻ᵀU until they are at rest at the modes where V is best
/// conditioned.
Eigen::MatrixXd changeWithFreeMotions(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& onFace) {
  constexpr double roundOff = 1e-12; // beside 1
  const Eigen::Index n = stiffness.rows();
  const Eigen::MatrixXd lower = factorOf(stiffness);
  const auto c = lower.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd half = c.solve(onFace),                            // C⁻¹S_F
      w = c.solve(half.transpose()),                                       // C⁻¹S_F C⁻ᵀ
      upperInverse = c.transpose().solve(Eigen::MatrixXd::Identity(n, n)); // C⁻ᵀ
  const direct::SymmetricEigen modes = direct::eigenOf(0.5 * (w + w.transpose()));
  const Eigen::Index numFree = modes.numUpTo(roundOff);
  const auto held = modes.vectors.rightCols(n - numFree);
  Eigen::MatrixXd inverse =
      held * modes.values.tail(n - numFree).cwiseInverse().asDiagonal() * held.transpose();
  if (numFree > 0) {
    const Eigen::MatrixXd u = modes.vectors.leftCols(numFree), v = upperInverse * u;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(v.transpose());
    const Eigen::VectorXi anchors = qr.colsPermutation().indices().head(numFree);
    const Eigen::MatrixXd rest =
        Eigen::MatrixXd::Identity(n, n) -
        u * v(anchors, Eigen::all).partialPivLu().solve(upperInverse(anchors, Eigen::all));
    inverse = rest * inverse * rest.transpose();
  }
  inverse.diagonal().array() -= 1;
  return lower * inverse * lower.transpose();
}

} // namespace

ContactStiffness::ContactStiffness(const ContactGram& gram, const GramInverse& inverse) {
  const std::vector<int>& modes = gram.modes();
  const auto n = static_cast<Eigen::Index>(modes.size());
  Eigen::MatrixXd flexibility(n, n); // EᵀN⁻¹E
  std::vector<double> unit(static_cast<std::size_t>(inverse.size())), motion(unit.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    double& force = unit[static_cast<std::size_t>(modes[static_cast<std::size_t>(j)])];
    force = 1;
    inverse.apply(unit, motion);
    force = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      flexibility(i, j) = motion[static_cast<std::size_t>(modes[static_cast<std::size_t>(i)])];
  }
  if (n == 0)
    return;
  matrix = direct::inverseOfSpd((0.5 * (flexibility + flexibility.transpose())).eval());
  pivots = factorOf(matrix).diagonal().cwiseAbs2();
}

KernelFaceInverse::KernelFaceInverse(std::shared_ptr<const ContactGram> gram,
                                     std::shared_ptr<const GramInverse> inverse,
                                     std::shared_ptr<const ContactStiffness> stiffness)
    : gram_(std::move(gram)), inverse_(std::move(inverse)), stiffness_(std::move(stiffness)),
      resultant_(static_cast<std::size_t>(inverse_->size())), atContact_(stiffness_->pivots.size()),
      reaction_(atContact_.size()) {
  const int n = static_cast<int>(atContact_.size()), ranks = inverse_->comm()->getSize();
  counts_ =
      inverse_->isSpread() ? evenShares(n, ranks) : std::vector<int>(static_cast<std::size_t>(ranks), n);
  first_ = inverse_->isSpread()
               ? std::accumulate(counts_.begin(), counts_.begin() + inverse_->comm()->getRank(), 0)
               : 0;
}

void KernelFaceInverse::setFace(const Vector& face) {
  const Eigen::MatrixXd missing = gram_->offFace(face); // D
  isWhole_ = missing.isZero(0);
  if (isWhole_)
    return;
  const Eigen::Index mine = counts_[static_cast<std::size_t>(inverse_->comm()->getRank())];
  const Eigen::MatrixXd& stiffness = stiffness_->matrix;
  const Eigen::MatrixXd onFace = stiffness - missing; // S_F
  constexpr double wellHeld = 1e-6; // pivots so large beside those of S leave no doubt that S_F is regular
  const std::optional<Eigen::MatrixXd> lower = direct::choleskyFactor(onFace);
  if (lower && (lower->diagonal().cwiseAbs2().array() > wellHeld * stiffness_->pivots.array()).all()) {
    const auto c = lower->triangularView<Eigen::Lower>();
    const Eigen::MatrixXd half = c.solve(missing.middleCols(first_, mine));
    change_.noalias() = stiffness * c.transpose().solve(half); // S S_F⁻¹ D
  } else {
    change_ = changeWithFreeMotions(stiffness, onFace).middleCols(first_, mine);
  }
}

void KernelFaceInverse::apply(std::span<const double> b, std::span<double> mu) const {
  inverse_->apply(b, mu);
  if (isWhole_)
    return;
  const std::vector<int>& modes = gram_->modes();
  for (std::size_t i = 0; i < modes.size(); ++i)
    atContact_[static_cast<Eigen::Index>(i)] = mu[static_cast<std::size_t>(modes[i])];
  if (inverse_->isSpread()) {
    share_.noalias() = change_.transpose() * atContact_;
    gatherOnAll<double>(*inverse_->comm(), {share_.data(), static_cast<std::size_t>(share_.size())}, counts_,
                        {reaction_.data(), modes.size()});
  } else {
    reaction_.noalias() = change_.transpose() * atContact_;
  }
  std::copy(b.begin(), b.end(), resultant_.begin());
  for (std::size_t i = 0; i < modes.size(); ++i)
    resultant_[static_cast<std::size_t>(modes[i])] += reaction_[static_cast<Eigen::Index>(i)];
  inverse_->apply(resultant_, mu);
}

} // namespace epafi::fetidp
