#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/ClusterFaceInverse.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Eigen/SparseCholesky>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::fetidp {

NaturalCoarseSpace::NaturalCoarseSpace(const decomposition::DecomposedProblem& problem,
                                       std::vector<KernelEntry> entries)
    : comm_(problem.comm), entries_(std::move(entries)),
      gram_(std::make_shared<const KernelGram>(problem, entries_)), anchors_(anchorsOf(problem)),
      sums_(static_cast<std::size_t>(problem.kernelDimension)), work_(problem.kernelDimension),
      product_(problem.kernelDimension) {
  const Eigen::SimplicialLLT<KernelGram::Matrix> factor(gram_->whole());
  if (factor.info() != Eigen::Success)
    throw Error(
        "the rows of G are linearly dependent: some rigid motion of the floating bodies meets no contact");
  lower_ = factor.matrixL();
  order_ = factor.permutationP();
}

/// G̃x; L⁻¹ waits for the sum, so that the order of the terms does not matter.
void NaturalCoarseSpace::addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const {
  const std::span<const double> values = qp::localData(x);
  for (const KernelEntry& entry : entries_)
    sums[static_cast<std::size_t>(entry.mode)].add(entry.value * values[static_cast<std::size_t>(entry.row)]);
}

void NaturalCoarseSpace::finishProduct(std::span<const AccurateSum> sums, std::span<double> gx) const {
  for (std::size_t k = 0; k < gx.size(); ++k)
    gx[static_cast<std::size_t>(order_.indices()[static_cast<Eigen::Index>(k)])] = sums[k].value(); // Π G̃x
  Eigen::Map<Eigen::VectorXd> product(gx.data(), static_cast<Eigen::Index>(gx.size()));
  lower_.triangularView<Eigen::Lower>().solveInPlace(product); // L⁻¹
}

void NaturalCoarseSpace::addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const {
  for (std::size_t k = 0; k < mu.size(); ++k)
    work_[static_cast<Eigen::Index>(k)] = factor * mu[k];
  lower_.transpose().triangularView<Eigen::Upper>().solveInPlace(work_); // L⁻ᵀ μ
  const std::span<double> values = qp::localDataNonConst(y);
  for (const KernelEntry& entry : entries_)
    values[static_cast<std::size_t>(entry.row)] += entry.value * work_[order_.indices()[entry.mode]]; // G̃ᵀΠᵀ
}

const Eigen::VectorXd& NaturalCoarseSpace::product(const Vector& x) const {
  std::fill(sums_.begin(), sums_.end(), AccurateSum());
  addLocalProduct(x, sums_);
  sumOverRanks(*comm_, sums_);
  finishProduct(sums_, {product_.data(), sums_.size()});
  return product_;
}

void NaturalCoarseSpace::project(Vector& x) const {
  const Eigen::VectorXd& gx = product(x);
  addTransposedProduct({gx.data(), sums_.size()}, -1.0, x);
}

Eigen::VectorXd NaturalCoarseSpace::normalized(const Eigen::VectorXd& kernelLoad) const {
  Eigen::VectorXd e = order_ * kernelLoad;
  lower_.triangularView<Eigen::Lower>().solveInPlace(e);
  return e;
}

Eigen::VectorXd NaturalCoarseSpace::motionOf(std::span<const double> mu) const {
  Eigen::VectorXd motion = Eigen::Map<const Eigen::VectorXd>(mu.data(), static_cast<Eigen::Index>(mu.size()));
  lower_.transpose().triangularView<Eigen::Upper>().solveInPlace(motion);
  return order_.transpose() * motion;
}

void NaturalCoarseSpace::resultantOf(std::span<const double> e, Eigen::VectorXd& kernelLoad) const {
  work_.noalias() = lower_ * Eigen::Map<const Eigen::VectorXd>(e.data(), static_cast<Eigen::Index>(e.size()));
  kernelLoad.noalias() = order_.transpose() * work_;
}

void NaturalCoarseSpace::multiplierOf(const Eigen::VectorXd& motion, std::span<double> mu) const {
  work_.noalias() = order_ * motion;
  Eigen::Map<Eigen::VectorXd>(mu.data(), static_cast<Eigen::Index>(mu.size())).noalias() =
      lower_.transpose() * work_;
}

void NaturalCoarseSpace::feasiblePoint(const Eigen::VectorXd& e, Vector& lambda) const {
  lambda.putScalar(0.0);
  addTransposedProduct({e.data(), static_cast<std::size_t>(e.size())}, 1.0, lambda);
}

std::unique_ptr<qp::FaceInverse> NaturalCoarseSpace::faceInverse(const RCP<const Map>& map) const {
  if (!anchors_)
    return ReplicatedEquality::faceInverse(map);
  return std::make_unique<ClusterFaceInverse>(*this, gram_, *anchors_);
}

} // namespace epafi::fetidp
