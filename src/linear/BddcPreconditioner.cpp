#include "epafi/linear/BddcPreconditioner.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/linear/LinearProblemChecks.hpp"
#include "epafi/linear/NodalBasis.hpp"

#include <Tpetra_Map.hpp>

#include <utility>

namespace epafi::linear {
namespace {

using decomposition::Subdomain;

void zeroRows(Eigen::MatrixXd& values, const std::vector<int>& rows) {
  for (const int row : rows)
    values.row(row).setZero();
}

} // namespace

BoundaryStiffness::BoundaryStiffness(const decomposition::DecomposedProblem& problem,
                                     std::shared_ptr<const fetidp::GeneralizedInverse> inverse)
    : inverse_(std::move(inverse)), boundary_(problem.subdomains.size()) {
  for (const fetidp::SubdomainGroup& group : inverse_->groups()) {
    blocks_.push_back(group.boundaryStiffness(direct::SymmetricBlock::Precision::full));
    for (const std::size_t member : group.members())
      boundary_[member] = group.condensed().interface().boundaryUnknowns;
  }
}

void BoundaryStiffness::apply(const SubdomainVectors& u, SubdomainVectors& forces) const {
  forces.resize(u.size());
  const auto groups = inverse_->groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto members = groups[g].members();
    const std::vector<int>& boundary = boundary_[members.front()];
    const Eigen::Index columns = u[members.front()].cols();
    input_.resize(boundary.size(), members.size() * columns);
    output_.resizeLike(input_);
    Eigen::Index place = 0;
    for (const std::size_t member : members) {
      input_.middleCols(place, columns) = u[member](boundary, allOf);
      place += columns;
    }
    blocks_[g]->apply(input_, output_);
    place = 0;
    for (const std::size_t member : members) {
      forces[member].setZero(u[member].rows(), columns);
      forces[member](boundary, allOf) = output_.middleCols(place, columns);
      place += columns;
    }
  }
}

std::size_t BoundaryStiffness::bytes() const {
  std::size_t sum = 0;
  for (const auto& block : blocks_)
    sum += block->bytes();
  return sum;
}

BddcPreconditioner::BddcPreconditioner(RCP<const UnassembledOperator> k, const BddcParameters& parameters)
    : SymmetricOperator(k->getDomainMap()), k_(std::move(k)),
      inverse_(std::make_shared<const fetidp::GeneralizedInverse>(requireLinearProblem(*k_, "BDDC"),
                                                                  parameters.directSolvers)),
      shares_(k_->problem(), k_->exchange(), parameters.scaling), stiffness_(k_->problem(), inverse_),
      sum_(rcp(new MultiVector(k_->getRangeMap(), 1))) {}

void BddcPreconditioner::multiply(const MultiVector& x, MultiVector& y) const {
  const int numColumns = static_cast<int>(x.getNumVectors());
  if (sum_->getNumVectors() != x.getNumVectors())
    sum_ = rcp(new MultiVector(k_->getRangeMap(), x.getNumVectors()));
  const std::vector<Subdomain>& subdomains = k_->problem().subdomains;
  k_->exchange().toSubdomains(x, forces_);
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    toForcesOfUnknowns(subdomains[s], forces_[s]);
  condenseInteriors(numColumns);
  shareOut();
  inverse_->apply(forces_, values_, numColumns, work_);
  average();
  extendIntoInteriors(numColumns);
  shares_.scale(values_); // the copies agree
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    toValues(subdomains[s], values_[s]);
  k_->exchange().sum(values_, y);
  k_->copyIdentity(x, y);
}

/// The forces t = −K_ΔI K_II⁻¹ f_I that interiors pass on to their boundaries: K_rr w = (f_I, 0) moves a
/// boundary, and t = S w_Δ holds it.
void BddcPreconditioner::condenseInteriors(int numColumns) const {
  local_.resize(forces_.size());
  values_.resize(forces_.size());
  for (std::size_t s = 0; s < forces_.size(); ++s) {
    local_[s] = forces_[s];
    zeroRows(local_[s], stiffness_.boundary(s));
    values_[s].setZero(forces_[s].rows(), forces_[s].cols()); // crosspoints are held
  }
  inverse_->solveRemainders(local_, values_, numColumns, work_);
  stiffness_.apply(values_, reaction_);
  k_->exchange().sum(reaction_, *sum_);
  k_->exchange().toSubdomains(*sum_, shared_);
}

/// Each subdomain gets its share of the forces at boundaries and crosspoints. On the boundary t is taken off
/// again, for K̄⁻¹ condenses the interiors once more: f_Δ = D(f + Σt) − t.
void BddcPreconditioner::shareOut() const {
  const std::vector<Subdomain>& subdomains = k_->problem().subdomains;
  for (std::size_t s = 0; s < forces_.size(); ++s) {
    const Eigen::VectorXd& share = shares_.of(s);
    for (const int unknown : stiffness_.boundary(s))
      forces_[s].row(unknown) =
          share[unknown] * (forces_[s].row(unknown) + shared_[s].row(unknown)) - reaction_[s].row(unknown);
    for (const int unknown : subdomains[s].crosspointUnknowns)
      forces_[s].row(unknown) *= share[unknown];
  }
}

/// The mean of the copies, on all of them.
void BddcPreconditioner::average() const {
  for (std::size_t s = 0; s < values_.size(); ++s)
    local_[s] = values_[s];
  shares_.scale(local_);
  k_->exchange().sum(local_, *sum_);
  k_->exchange().toSubdomains(*sum_, shared_);
}

/// Boundaries go to their means, and interiors follow: by K_rr⁻¹ of the forces S δ that move the boundary by
/// δ.
void BddcPreconditioner::extendIntoInteriors(int numColumns) const {
  for (std::size_t s = 0; s < values_.size(); ++s)
    local_[s] = shared_[s] - values_[s];
  stiffness_.apply(local_, reaction_);
  for (std::size_t s = 0; s < values_.size(); ++s)
    local_[s].setZero();
  inverse_->solveRemainders(reaction_, local_, numColumns, work_);
  for (std::size_t s = 0; s < values_.size(); ++s)
    values_[s] += local_[s];
}

} // namespace epafi::linear
