#include "epafi/fetidp/BoundaryPreconditioner.hpp"

#include "epafi/base/Collective.hpp"

#include <utility>

namespace epafi::fetidp {
namespace {

std::shared_ptr<const direct::SymmetricBlock> stiffnessOf(const decomposition::DecomposedProblem& problem,
                                                          const SubdomainGroup& group,
                                                          const PreconditionerParameters& parameters) {
  using Precision = direct::SymmetricBlock::Precision;
  const auto precision = parameters.isSingle ? Precision::single : Precision::full;
  if (parameters.type == PreconditionerParameters::Type::dirichlet)
    return group.boundaryStiffness(precision);
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
  work.displacement.resize(all.condensed().numBoundary(),
                           static_cast<Eigen::Index>(all.members().size()) * numColumns);
  work.forces.resizeLike(work.displacement);
  return work;
}

void BoundaryPreconditioner::apply(const MultiVector& x, MultiVector& y) const {
  const auto numColumns = static_cast<Eigen::Index>(x.getNumVectors());
  const std::span<const double> lambda = input_.toSubdomains(x);
  const std::span<double> result = output_.zeros(x.getNumVectors());
  for (std::size_t g = 0; g < blocks_.size(); ++g) {
    Work& work = prepared(g, numColumns);
    work.displacement.setZero();
    addTransposed(blocks_[g].scaled, lambda, numColumns, work.displacement);
    blocks_[g].stiffness->apply(work.displacement, work.forces);
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
      work.displacement.col(static_cast<Eigen::Index>(m)) =
          u[group.members()[m]].col(0)(group.condensed().interface().boundaryUnknowns);
    blocks_[g].stiffness->apply(work.displacement, work.forces);
    addProduct(blocks_[g].scaled, work.forces, 1, result);
  }
  output_.sumToOwners(y);
}

std::size_t BoundaryPreconditioner::bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_)
    bytes += block.stiffness->bytes();
  return bytes;
}

} // namespace epafi::fetidp
