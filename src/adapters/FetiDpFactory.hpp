#pragma once

/// FETI-DP as one of the linear solvers that Thyra knows.

#include "epafi/adapters/ConfiguredFactory.hpp"
#include "epafi/adapters/FetiDpSolve.hpp"
#include "epafi/linear/LinearParameters.hpp"

#include <Thyra_LinearOpWithSolveFactoryBase_decl.hpp>

namespace epafi::adapters {

/// Makes solvers for asThyra(UnassembledOperator), scaled and transposed ones too, and says no to all others.
///
/// Life cycle: createOp, then initializeOp, which factorises; any number of solves; initializeOp again for
/// another operator, or for the same one when its matrices have changed, which keeps what still holds
/// (linear::FetiDpSolver::update). An operator that was made stays good without the factory.
class FetiDpFactory final
    : public ConfiguredFactory<Thyra::LinearOpWithSolveFactoryBase<double>, linear::FetiDpParameters> {
public:
  FetiDpFactory() : ConfiguredFactory("FETI-DP") {}

  [[nodiscard]] bool isCompatible(const Thyra::LinearOpSourceBase<double>& source) const override;
  [[nodiscard]] RCP<Thyra::LinearOpWithSolveBase<double>> createOp() const override;
  /// Collective. \throws what linear::FetiDpSolver throws; InputError if the operator is not compatible
  void initializeOp(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                    Thyra::LinearOpWithSolveBase<double>* op,
                    Thyra::ESupportSolveUse use = Thyra::SUPPORT_SOLVE_UNSPECIFIED) const override;
  void uninitializeOp(Thyra::LinearOpWithSolveBase<double>* op,
                      RCP<const Thyra::LinearOpSourceBase<double>>* source,
                      RCP<const Thyra::PreconditionerBase<double>>* preconditioner,
                      RCP<const Thyra::LinearOpSourceBase<double>>* approximateSource,
                      Thyra::ESupportSolveUse* use) const override;
};

} // namespace epafi::adapters
