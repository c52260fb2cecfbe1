#include "epafi/qp/solve/FacePreconditioner.hpp"

#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Timing.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <Tpetra_Map.hpp>

#include <utility>

namespace epafi::qp {

FacePreconditioner::FacePreconditioner(RCP<const Operator> m, const RCP<const Map>& map, StepCounts& counts)
    : m_(std::move(m)), timer_(Teuchos::TimeMonitor::getNewCounter("Epafi::qp: preconditioner")),
      counts_(counts), r_(map), z_(map), reduction_(map->getComm(), numSums + 1) {}

void FacePreconditioner::apply() {
  if (m_.is_null()) {
    z_.assign(r_);
    return;
  }
  const Timing timing(*timer_);
  m_->apply(r_, z_);
  ++counts_.preconditionerApplications;
}

void FacePreconditioner::applyToFree(const ConvexSet& set, const Vector& x, const Vector& g) {
  set.subtractFromFreeGradient(x, g, 0.0, r_);
  apply();
  set.restrictToFree(x, z_);
}

void FacePreconditioner::applyToReleased(const ConvexSet& set, const Vector& x, const Vector& g,
                                         double negligible) {
  set.projectedGradient(x, g, negligible, r_);
  apply();
  set.restrictToReleased(x, g, negligible, z_);
}

void FacePreconditioner::applyInFace(const Vector& face, const Vector& g) {
  const auto mask = localData(face);
  {
    const auto gradient = localData(g);
    const auto r = localDataNonConst(r_);
    for (std::size_t i = 0; i < r.size(); ++i)
      r[i] = mask[i] * gradient[i];
  }
  apply();
  const auto z = localDataNonConst(z_);
  for (std::size_t i = 0; i < z.size(); ++i)
    z[i] *= mask[i];
}

double FacePreconditioner::energyOf(const ConvexSet& set, const Vector& x, const Vector& g) {
  set.projectedGradient(x, g, 0.0, r_);
  apply();
  return products(r_).energy;
}

void FacePreconditioner::addSums(const Vector& w, std::span<AccurateSum> sums) const {
  const auto r = localData(r_), z = localData(z_), image = localData(w);
  for (std::size_t i = 0; i < z.size(); ++i) {
    sums[0].add(r[i] * z[i]);
    sums[1].add(z[i] * image[i]);
  }
}

FacePreconditioner::Products FacePreconditioner::products(const Vector& w, bool& isToStop) {
  reduction_.clear();
  addSums(w, reduction_.sums());
  reduction_.sums()[numSums] = AccurateSum(isToStop ? 1.0 : 0.0);
  reduction_.reduce();
  isToStop = reduction_.sum(numSums) > 0;
  return {reduction_.sum(0), reduction_.sum(1)};
}

} // namespace epafi::qp
