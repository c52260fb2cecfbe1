#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include "epafi/fetidp/equilibrium/KernelFaceInverse.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <utility>

namespace epafi::fetidp {
namespace {

std::span<double> entriesOf(Eigen::VectorXd& x) {
  return std::span(x.data(), x.size());
}

} // namespace

NaturalCoarseSpace::NaturalCoarseSpace(const decomposition::DecomposedProblem& problem,
                                       std::vector<KernelEntry> entries, GramInverse::Form form)
    : comm_(problem.comm), entries_(std::move(entries)),
      inverse_(std::make_shared<const GramInverse>(problem, entries_, form)),
      contactGram_(std::make_shared<const ContactGram>(problem, entries_)), sums_(problem.kernelDimension),
      product_(problem.kernelDimension), motion_(problem.kernelDimension) {}

void NaturalCoarseSpace::addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const {
  const std::span<const double> values = qp::localData(x);
  for (const KernelEntry& entry : entries_)
    sums[entry.mode].add(entry.value * values[entry.row]);
}

void NaturalCoarseSpace::addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const {
  const std::span<double> values = qp::localDataNonConst(y);
  for (const KernelEntry& entry : entries_)
    values[entry.row] += entry.value * (factor * mu[entry.mode]);
}

const Eigen::VectorXd& NaturalCoarseSpace::product(const Vector& x) const {
  std::fill(sums_.begin(), sums_.end(), AccurateSum());
  addLocalProduct(x, sums_);
  sumOverRanks(*comm_, sums_, product_.data());
  return product_;
}

void NaturalCoarseSpace::project(Vector& x) const {
  const Eigen::VectorXd& resultants = product(x);
  inverse_->apply({resultants.data(), sums_.size()}, entriesOf(motion_));
  addTransposedProduct(entriesOf(motion_), -1.0, x);
}

void NaturalCoarseSpace::feasiblePoint(const Eigen::VectorXd& resultants, Vector& lambda) const {
  inverse_->apply({resultants.data(), sums_.size()}, entriesOf(motion_));
  lambda.putScalar(0.0);
  addTransposedProduct(entriesOf(motion_), 1.0, lambda);
}

std::unique_ptr<qp::FaceInverse> NaturalCoarseSpace::faceInverse(const RCP<const Map>& /*map*/) const {
  if (!contactStiffness_)
    contactStiffness_ = std::make_shared<const ContactStiffness>(*contactGram_, *inverse_);
  return std::make_unique<KernelFaceInverse>(contactGram_, inverse_, contactStiffness_);
}

} // namespace epafi::fetidp
