#include "epafi/fetidp/KernelFaceInverse.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <numeric>
#include <utility>

namespace epafi::fetidp {
namespace {

/// W⁻ where W has eigenvalues that are 0: the pseudo-inverse, changed by motions V = L U, U the null space, until they are at rest at the
/// modes where V is best conditioned.
Eigen::MatrixXd generalizedInverse(const Eigen::MatrixXd& w, const Eigen::MatrixXd& lower) {
  constexpr double roundOff = 1e-12; // beside 1
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(w);
  if (modes.info() != Eigen::Success)
    throw Error("the motions of floating bodies on a face could not be decomposed");
  const Eigen::Index n = w.rows();
  Eigen::Index numFree = 0; // ascending eigenvalues
  while (numFree < n && !(modes.eigenvalues()[numFree] > roundOff))
    ++numFree;
  const auto held = modes.eigenvectors().rightCols(n - numFree);
  const Eigen::MatrixXd pseudo =
      held * modes.eigenvalues().tail(n - numFree).cwiseInverse().asDiagonal() * held.transpose();
  if (numFree == 0)
    return pseudo;
  const Eigen::MatrixXd u = modes.eigenvectors().leftCols(numFree), v = lower * u;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(v.transpose());
  const Eigen::VectorXi anchors = qr.colsPermutation().indices().head(numFree);
  const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(n, n) -
                               u * v(anchors, Eigen::all).partialPivLu().solve(lower(anchors, Eigen::all));
  return rest * pseudo * rest.transpose();
}

} // namespace

Eigen::MatrixXd contactFactor(const ContactGram& gram, const GramInverse& inverse) {
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
  const Eigen::LLT<Eigen::MatrixXd> factor(0.5 * (flexibility + flexibility.transpose()));
  if (factor.info() != Eigen::Success)
    throw Error(
        "the rows of G are linearly dependent: some rigid motion of the floating bodies meets no contact");
  return factor.matrixL();
}

KernelFaceInverse::KernelFaceInverse(std::shared_ptr<const ContactGram> gram,
                                     std::shared_ptr<const GramInverse> inverse,
                                     std::shared_ptr<const Eigen::MatrixXd> lower)
    : gram_(std::move(gram)), inverse_(std::move(inverse)), lower_(std::move(lower)), comm_(inverse_->comm()),
      resultant_(static_cast<std::size_t>(inverse_->size())), atContact_(lower_->rows()),
      reaction_(lower_->rows()) {
  const int n = static_cast<int>(lower_->rows());
  counts_ = inverse_->isSpread() ? evenShares(n, comm_->getSize())
                                 : std::vector<int>(static_cast<std::size_t>(comm_->getSize()), n);
}

void KernelFaceInverse::setFace(const Vector& face) {
  const Eigen::MatrixXd missing = gram_->offFace(face); // D
  isWhole_ = missing.isZero(0);
  if (isWhole_)
    return;
  const Eigen::Index n = missing.rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd w = identity - lower_->transpose() * missing * *lower_;
  w = (0.5 * (w + w.transpose())).eval();
  constexpr double wellHeld = 1e-6; // a pivot so large leaves no doubt that W is regular
  const Eigen::LLT<Eigen::MatrixXd> factor(w);
  const bool isHeld =
      factor.info() == Eigen::Success && factor.matrixLLT().diagonal().cwiseAbs2().minCoeff() > wellHeld;
  const Eigen::MatrixXd inverse =
      isHeld ? Eigen::MatrixXd(factor.solve(identity)) : generalizedInverse(w, *lower_);
  const auto upper = lower_->transpose().triangularView<Eigen::Upper>();
  const Eigen::MatrixXd half = upper.solve(inverse - identity); // L⁻ᵀ(W⁻ − I)
  const auto mine = counts_.begin() + comm_->getRank();
  const int first = inverse_->isSpread() ? std::accumulate(counts_.begin(), mine, 0) : 0;
  change_ = upper.solve(half.middleRows(first, *mine).transpose()); // K = Kᵀ
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
    gatherOnAll<double>(*comm_, {share_.data(), static_cast<std::size_t>(share_.size())}, counts_,
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
