#include "epafi/fetidp/equilibrium/KernelFaceInverse.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace epafi::fetidp {
namespace {

/// C of S = CCᵀ. \throws Error if S is not positive definite.
Eigen::MatrixXd factorOf(const Eigen::MatrixXd& stiffness) {
  std::optional<Eigen::MatrixXd> lower = direct::choleskyFactor(stiffness);
  if (!lower)
    throw Error("contact and gluing hold the motions of the clusters of subdomains no better than round-off");
  return *std::move(lower);
}

/// How often what is lost where so small a share of S is left has to be refined.
int refinementsFor(double share) {
  constexpr double wellHeld = 1e-2, held = 1e-7;
  return share > wellHeld ? 0 : share > held ? 1 : 3;
}

} // namespace

ContactStiffness::ContactStiffness(const ContactGram& gram, const GramInverse& inverse) {
  const std::vector<int>& modes = gram.modes();
  const Eigen::Index n = modes.size();
  Eigen::MatrixXd flexibility(n, n); // EᵀN⁻¹E
  std::vector<double> unit(inverse.size()), motion(unit.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    double& force = unit[modes[j]];
    force = 1;
    inverse.apply(unit, motion);
    force = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      flexibility(i, j) = motion[modes[i]];
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
      shares_(inverse_->comm(), static_cast<int>(stiffness_->pivots.size())), resultant_(inverse_->size()),
      residual_(resultant_.size()), correction_(resultant_.size()), atContact_(stiffness_->pivots.size()),
      reaction_(atContact_.size()), onFace_(atContact_.size()) {}

/// X ← S_δ⁻¹X.
template <class Matrix>
void KernelFaceInverse::solveInPlace(Matrix& x) const {
  const auto c = lower_.triangularView<Eigen::Lower>();
  c.solveInPlace(x);
  c.transpose().solveInPlace(x);
}

void KernelFaceInverse::setFace(const qp::Face& face) {
  Eigen::MatrixXd missing = gram_->offFace(face); // D
  isWhole_ = missing.isZero(0);
  if (isWhole_)
    return;
  missing_ = missing.sparseView();
  const Eigen::MatrixXd& stiffness = stiffness_->matrix;
  const std::vector<int>& anchors = gram_->anchors();
  const Eigen::Index numAnchors = anchors.size();
  const double delta = stiffness.diagonal().mean();
  for (const int anchor : anchors)
    missing(anchor, anchor) -= delta;     // D − δAAᵀ
  lower_ = factorOf(stiffness - missing); // of S_δ
  response_.setZero(stiffness.rows(), numAnchors);
  for (Eigen::Index i = 0; i < numAnchors; ++i)
    response_(anchors[i], i) = delta;
  solveInPlace(response_);
  const direct::SymmetricEigen modes =
      direct::eigenOf(Eigen::MatrixXd::Identity(numAnchors, numAnchors) - response_(anchors, allOf));
  constexpr double roundOff = 1e-12; // beside 1
  const Eigen::Index numFree = modes.numUpTo(roundOff), numHeld = numAnchors - numFree;
  const auto held = modes.vectors.rightCols(numHeld);
  atAnchors_ = held * modes.values.tail(numHeld).cwiseInverse().asDiagonal() * held.transpose();
  double share = (lower_.diagonal().cwiseAbs2().array() / stiffness_->pivots.array()).minCoeff();
  if (numHeld > 0)
    share = std::min(share, modes.values[numFree]);
  numRefinements_ = refinementsFor(share);
  if (inverse_->isSpread())
    makeRows(missing, delta);
}

/// This rank's rows of K = S S_δ⁻¹(D − δAAᵀ) + δS S_δ⁻¹A (I − δAᵀS_δ⁻¹A)⁺ AᵀS_δ⁻¹S.
void KernelFaceInverse::makeRows(const Eigen::MatrixXd& missing, double delta) {
  Eigen::MatrixXd columns = missing.middleCols(shares_.first(), shares_.size());
  solveInPlace(columns);
  rows_.noalias() = stiffness_->matrix * columns;
  const Eigen::MatrixXd forces = stiffness_->matrix * response_;
  rows_.noalias() +=
      forces * (atAnchors_ / delta) * forces.middleRows(shares_.first(), shares_.size()).transpose();
}

/// reaction = K times the motion at contact.
void KernelFaceInverse::react() const {
  if (inverse_->isSpread()) {
    share_.noalias() = rows_.transpose() * atContact_;
    shares_.gather(std::span(share_.data(), share_.size()), std::span(reaction_.data(), reaction_.size()));
    return;
  }
  reaction_.noalias() = stiffness_->matrix.selfadjointView<Eigen::Lower>() * atContact_;
  onFace_ = reaction_;
  solveInPlace(onFace_);
  share_ = onFace_(gram_->anchors());
  held_.noalias() = atAnchors_ * share_;
  onFace_.noalias() += response_ * held_; // S_F⁻ S times the motion
  reaction_ *= -1;
  reaction_.noalias() += stiffness_->matrix.selfadjointView<Eigen::Lower>() * onFace_;
}

void KernelFaceInverse::apply(std::span<const double> b, std::span<double> mu) const {
  if (isWhole_) {
    inverse_->apply(b, mu);
    return;
  }
  applyOnce(b, mu);
  const Eigen::Index size = mu.size();
  Eigen::Map<Eigen::VectorXd> found(mu.data(), size), residual(residual_.data(), size);
  const std::vector<int>& modes = gram_->modes();
  for (int step = 0; step < numRefinements_; ++step) {
    inverse_->multiply(mu, residual_);
    residual = Eigen::Map<const Eigen::VectorXd>(b.data(), size) - residual;
    atContact_ = found(modes);
    reaction_.noalias() = missing_ * atContact_;
    residual(modes) += reaction_; // b − N_F μ
    applyOnce(residual_, correction_);
    found += Eigen::Map<const Eigen::VectorXd>(correction_.data(), size);
  }
}

void KernelFaceInverse::applyOnce(std::span<const double> b, std::span<double> mu) const {
  inverse_->apply(b, mu);
  const std::vector<int>& modes = gram_->modes();
  for (std::size_t i = 0; i < modes.size(); ++i)
    atContact_[i] = mu[modes[i]];
  react();
  std::copy(b.begin(), b.end(), resultant_.begin());
  for (std::size_t i = 0; i < modes.size(); ++i)
    resultant_[modes[i]] += reaction_[i];
  inverse_->apply(resultant_, mu);
}

} // namespace epafi::fetidp
