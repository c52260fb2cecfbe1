#include "epafi/fetidp/precondition/BoundaryPreconditioner.hpp"

#include "epafi/base/Collective.hpp"

#include <utility>

namespace epafi::fetidp {
namespace {

/// Null where S_ΔΔ is not worth a block of its own: as F's is not.
std::shared_ptr<const direct::SymmetricBlock> stiffnessOf(const decomposition::DecomposedProblem& problem,
                                                          const SubdomainGroup& group,
                                                          const PreconditionerParameters& parameters) {
  using Precision = direct::SymmetricBlock::Precision;
  const auto precision = parameters.isSingle ? Precision::single : Precision::full;
  if (parameters.type == PreconditionerParameters::Type::dirichlet) {
    const bool isLeftToFactor =
        !parameters.isSingle && !group.isExplicit() && group.use() == direct::SymmetricBlock::Use::alone;
    return isLeftToFactor ? nullptr : group.boundaryStiffness(precision);
  }
  const std::vector<int>& unknowns = group.condensed().interface().boundaryUnknowns;
  const Eigen::MatrixXd k(
      block(*problem.subdomains[group.members().front()].stiffness, unknowns, unknowns)); // K_ΔΔ
  return std::make_shared<const direct::SymmetricBlock>(k, group.use(), precision);
}

/// B's entries in a group's boundaries with the weights of B_D for coefficients.
std::vector<InterfaceEntry> scaledEntries(const SubdomainGroup& group, const ScaledConstraint& scaled) {
  std::vector<InterfaceEntry> entries(group.boundaryEntries().begin(), group.boundaryEntries().end());
  auto entry = entries.begin();
  for (const std::size_t member : group.members())
    for (const double weight : scaled.boundary[member])
      (entry++)->coefficient = weight;
  return entries;
}

} // namespace

BoundaryPreconditioner::BoundaryPreconditioner(const decomposition::DecomposedProblem& problem,
                                               std::shared_ptr<const GeneralizedInverse> inverse,
                                               const ScaledConstraint& scaled,
                                               const PreconditionerParameters& parameters)
    : inverse_(std::move(inverse)), work_(inverse_->groups().size()), input_(inverse_->multiplierPlan()),
      output_(inverse_->multiplierPlan()) {
  collectively(*problem.comm, [&] {
    for (const SubdomainGroup& group : inverse_->groups())
      blocks_.push_back({stiffnessOf(problem, group, parameters), scaledEntries(group, scaled)});
  });
}

/// Work space of a group for k columns.
BoundaryPreconditioner::Work& BoundaryPreconditioner::prepared(std::size_t group,
                                                               Eigen::Index numColumns) const {
  const SubdomainGroup& all = inverse_->groups()[group];
  Work& work = work_[group];
  work.displacement.resize(all.condensed().numBoundary(), all.members().size() * numColumns);
  work.forces.resizeLike(work.displacement);
  return work;
}

/// forces = S_Δ displacement.
void BoundaryPreconditioner::multiply(std::size_t group, Work& work) const {
  if (blocks_[group].stiffness) {
    blocks_[group].stiffness->apply(work.displacement, work.forces);
    return;
  }
  direct::SpdFactor& factor = inverse_->groups()[group].condensed().factor();
  for (Eigen::Index column = 0; column < work.displacement.cols(); ++column)
    if (work.displacement.col(column).isZero(0))
      work.forces.col(column).setZero();
    else
      factor.multiplyKept(work.displacement.col(column), work.forces.col(column));
}

void BoundaryPreconditioner::apply(const MultiVector& x, MultiVector& y) const {
  const Eigen::Index numColumns = x.getNumVectors();
  const std::span<const double> lambda = input_.toSubdomains(x);
  const std::span<double> result = output_.zeros(x.getNumVectors());
  for (std::size_t g = 0; g < blocks_.size(); ++g) {
    Work& work = prepared(g, numColumns);
    work.displacement.setZero();
    addTransposed(blocks_[g].scaled, lambda, numColumns, work.displacement);
    multiply(g, work);
    addProduct(blocks_[g].scaled, work.forces, numColumns, result);
  }
  output_.sumToOwners(y);
}

void BoundaryPreconditioner::applyTo(const SubdomainVectors& u, Vector& y) const {
  const std::span<double> result = output_.zeros(1);
  for (std::size_t g = 0; g < blocks_.size(); ++g) {
    const SubdomainGroup& group = inverse_->groups()[g];
    Work& work = prepared(g, 1);
    for (std::size_t m = 0; m < group.members().size(); ++m)
      work.displacement.col(m) = u[group.members()[m]].col(0)(group.condensed().interface().boundaryUnknowns);
    multiply(g, work);
    addProduct(blocks_[g].scaled, work.forces, 1, result);
  }
  output_.sumToOwners(y);
}

std::size_t BoundaryPreconditioner::bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_)
    bytes += block.stiffness ? block.stiffness->bytes() : 0;
  return bytes;
}

} // namespace epafi::fetidp
