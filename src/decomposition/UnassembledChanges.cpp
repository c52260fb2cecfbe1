// What may change of an UnassembledProblem.

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

bool hasSamePattern(const SparseMatrix& a, const SparseMatrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

} // namespace

void UnassembledProblem::setTies(const ConstraintMatrix& ties) {
  if (crosspoints_)
    requireSound(ties, unknownMap_);
  ties_ = ties;
  if (crosspoints_)
    attach();
}

void UnassembledProblem::setContact(const ConstraintMatrix& contact) {
  if (!crosspoints_) {
    contact_ = contact;
    return;
  }
  requireComplete();
  requireSound(contact, unknownMap_);
  contact_ = contact;
  attach();
}

void UnassembledProblem::setCompliance(const RCP<const Vector>& compliance) {
  requireComplete();
  collectively(*problem_.comm, [&] {
    if (compliance.is_null())
      return;
    if (!compliance->getMap()->locallySameAs(*problem_.multiplierMap))
      throw InputError("the compliance must lie on the map of the multipliers.");
    const auto values = compliance->getData();
    if (!std::all_of(values.begin(), values.end(),
                     [](double value) { return value >= 0 && std::isfinite(value); }))
      throw InputError("the compliance of a row must be a finite number of at least 0.");
  });
  problem_.compliance = compliance;
}

void UnassembledProblem::setGap(const Vector& gap) {
  requireComplete();
  if (!contact_ || !gap.getMap()->locallySameAs(*contact_->rows->getRowMap()))
    throw InputError("the gaps must lie on the row map of the contact matrix.");
  contact_->gap = rcp(new Vector(gap, Teuchos::Copy)); // rows that are made anew keep it
  data_.setGaps(gap);
}

void UnassembledProblem::setLoad(std::size_t subdomain, const Eigen::VectorXd& load) {
  requireComplete();
  if (subdomain >= own_.size() || load.size() != own_[subdomain].load.size())
    throw InputError("a load of " + std::to_string(load.size()) + " numbers was given for subdomain " +
                     std::to_string(subdomain) + " of this rank's " + std::to_string(own_.size()) +
                     "; it must have one for each unknown.");
  own_[subdomain].load = load;
  refreshData(subdomain);
}

void UnassembledProblem::refreshData(std::size_t subdomain) {
  SubdomainData& data = data_.subdomains_[subdomain];
  refresh(own_[subdomain], data);
  const std::vector<Average>& averages = problem_.subdomains[subdomain].averages;
  data.load = loadInBasisOf(averages, std::move(data.load));
  data.reaction = loadInBasisOf(averages, std::move(data.reaction));
}

void UnassembledProblem::setMatrix(std::size_t subdomain, const SparseMatrix& stiffness) {
  requireComplete();
  const Eigen::Index n = subdomain < own_.size() ? own_[subdomain].row.size() : 0;
  if (stiffness.rows() != n || stiffness.cols() != n)
    throw InputError("a stiffness of " + std::to_string(stiffness.rows()) + " rows was given for subdomain " +
                     std::to_string(subdomain) + " of this rank, which has " + std::to_string(n) +
                     " unknowns.");
  OwnSubdomain& own = own_[subdomain];
  auto free = std::make_shared<SparseMatrix>(freeStiffness(stiffness, own));
  if (!hasSamePattern(*free, *nodal_[subdomain].stiffness))
    throw InputError("the new stiffness of subdomain " + std::to_string(subdomain) +
                     " of this rank has another pattern; make a problem anew for it.");
  nodal_[subdomain].stiffness = free;
  Subdomain& target = problem_.subdomains[subdomain];
  target.stiffness = AverageBasis().changed(target.averages, free);
  own.heldForce = stiffness * own.prescribed;
  refreshData(subdomain);
}

} // namespace epafi::decomposition
