// Solutions in the application's numbering.

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/UnassembledProblem.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Export.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::decomposition {

std::vector<GlobalOrdinal> UnassembledProblem::globalUnknowns(std::size_t subdomain) const {
  std::vector<GlobalOrdinal> result(problem_.numPositions(problem_.subdomains[subdomain]), -1);
  const OwnSubdomain& own = own_[subdomain];
  for (std::size_t i = 0; i < own.unknowns.size(); ++i)
    result[own.position[i]] = own.unknowns[i];
  return result;
}

Eigen::VectorXd UnassembledProblem::unknowns(std::size_t subdomain,
                                             std::span<const Eigen::VectorXd> displacement) const {
  return displacement[subdomain](own_[subdomain].position);
}

RCP<Vector> UnassembledProblem::unknowns(std::span<const Eigen::VectorXd> displacement) const {
  const RCP<const Map> map = ownUnknowns();
  Vector sums(map);
  for (std::size_t s = 0; s < own_.size(); ++s) {
    const Eigen::VectorXd u = unknowns(s, displacement);
    for (std::size_t i = 0; i < own_[s].unknowns.size(); ++i)
      sums.sumIntoGlobalValue(own_[s].unknowns[i], u[i]);
  }
  const RCP<Vector> result = rcp(new Vector(unknownMap_));
  result->doExport(sums, Export(map, unknownMap_), Tpetra::ADD);
  const auto values = result->getDataNonConst();
  const auto copies = copies_->getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    values[i] /= copies[i];
  return result;
}

RCP<Vector> UnassembledProblem::contactForces(const Vector& multiplier) const {
  requireComplete();
  if (!contact_)
    throw InputError("there are no forces of contact: no contact matrix was given.");
  const RCP<Vector> forces = rcp(new Vector(contact_->rows->getRowMap()));
  forces->doImport(multiplier, Import(multiplier.getMap(), forces->getMap()), Tpetra::INSERT);
  return forces;
}

} // namespace epafi::decomposition
