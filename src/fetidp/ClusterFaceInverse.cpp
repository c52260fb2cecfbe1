#include "epafi/fetidp/ClusterFaceInverse.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <utility>

namespace epafi::fetidp {

std::optional<std::vector<int>> anchorsOf(const decomposition::DecomposedProblem& problem) {
  std::vector<std::vector<const decomposition::Cluster*>> clusters(problem.bodies.size());
  bool isCut = false;
  for (const decomposition::Cluster& cluster : problem.clusters) {
    auto& ofBody = clusters[static_cast<std::size_t>(cluster.body)];
    ofBody.push_back(&cluster);
    isCut = isCut || ofBody.size() > 1;
  }
  if (!isCut)
    return std::nullopt;
  std::vector<int> anchors;
  for (const auto& ofBody : clusters) {
    std::vector<int> modes;
    for (const decomposition::Cluster* cluster : ofBody)
      for (int mode = 0; mode < cluster->kernelDimension; ++mode)
        modes.push_back(cluster->kernelOffset + mode);
    if (modes.empty() || ofBody.front()->ofBody.cols() == 0)
      continue;
    Eigen::MatrixXd motions(ofBody.front()->ofBody.cols(), static_cast<Eigen::Index>(modes.size())); // Xᵀ
    Eigen::Index first = 0;
    for (const decomposition::Cluster* cluster : ofBody) {
      motions.middleCols(first, cluster->kernelDimension) = cluster->ofBody.transpose();
      first += cluster->kernelDimension;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motions);
    for (Eigen::Index i = 0; i < motions.rows(); ++i)
      anchors.push_back(modes[static_cast<std::size_t>(qr.colsPermutation().indices()[i])]);
  }
  return anchors;
}

ClusterFaceInverse::ClusterFaceInverse(const NaturalCoarseSpace& space,
                                       std::shared_ptr<const KernelGram> gram, std::vector<int> anchors)
    : space_(space), gram_(std::move(gram)), anchors_(std::move(anchors)), resultant_(gram_->size()),
      permuted_(gram_->size()), motion_(gram_->size()), work_(static_cast<Eigen::Index>(anchors_.size())) {}

void ClusterFaceInverse::setFace(const Vector& face) {
  KernelGram::Matrix matrix = gram_->onFace(face);
  const double delta = matrix.diagonal().mean();
  for (const int anchor : anchors_)
    matrix.coeffRef(anchor, anchor) += delta;
  if (!std::exchange(hasPattern_, true))
    factor_.analyzePattern(matrix);
  factor_.factorize(matrix);
  if (factor_.info() != Eigen::Success)
    throw Error("the gluing of the clusters of subdomains does not hold them together");
  if (!anchors_.empty())
    solveAtAnchors(delta);
}

void ClusterFaceInverse::solveAtAnchors(double delta) {
  const auto m = static_cast<Eigen::Index>(anchors_.size());
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(gram_->size(), m);
  for (Eigen::Index i = 0; i < m; ++i)
    unit(anchors_[static_cast<std::size_t>(i)], i) = delta;
  response_ = factor_.solve(unit);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(Eigen::MatrixXd::Identity(m, m) -
                                                             response_(anchors_, Eigen::all));
  constexpr double roundOff = 1e-11; // beside 1
  atAnchors_.setZero(m, m);
  for (Eigen::Index i = 0; i < m; ++i)
    if (const double value = modes.eigenvalues()[i]; value > roundOff)
      atAnchors_ += modes.eigenvectors().col(i) * modes.eigenvectors().col(i).transpose() / value;
}

void ClusterFaceInverse::apply(std::span<const double> b, std::span<double> mu) const {
  space_.resultantOf(b, resultant_);
  permuted_.noalias() = factor_.permutationP() * resultant_;
  factor_.matrixL().solveInPlace(permuted_);
  factor_.matrixU().solveInPlace(permuted_);
  motion_.noalias() = factor_.permutationPinv() * permuted_; // N_δ⁻¹ b without any allocation
  if (!anchors_.empty()) {
    work_.noalias() = atAnchors_ * motion_(anchors_);
    motion_.noalias() += response_ * work_;
  }
  space_.multiplierOf(motion_, mu);
}

} // namespace epafi::fetidp
