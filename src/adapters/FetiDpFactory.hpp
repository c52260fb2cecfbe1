#pragma once

/// FETI-DP as one of the linear solvers that Thyra knows.

#include "epafi/adapters/FetiDpSolve.hpp"
#include "epafi/linear/LinearParameters.hpp"

#include <Thyra_LinearOpWithSolveFactoryBase_decl.hpp>

namespace epafi::adapters {

/// Makes solvers for asThyra(UnassembledOperator), scaled and transposed ones too, and says no to all others.
///
/// Life cycle: createOp, then initializeOp, which factorises; any number of solves; initializeOp again for another operator, or for
/// the same one when its matrices have changed, which keeps what still holds (linear::FetiDpSolver::update). An operator that was made stays good without the factory.
/// Parameters: FetiDpParameters::validParameters, and the list "VerboseObject" that Thyra's factories have.
class FetiDpFactory final : public Thyra::LinearOpWithSolveFactoryBase<double> {
public:
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
  [[nodiscard]] std::string description() const override { return "Epafi FETI-DP"; }

  /// \throws InputError that names list, parameter, value and what is allowed
  void setParameterList(const RCP<Teuchos::ParameterList>& list) override;
  [[nodiscard]] RCP<Teuchos::ParameterList> getNonconstParameterList() override { return list_; }
  [[nodiscard]] RCP<Teuchos::ParameterList> unsetParameterList() override;
  [[nodiscard]] RCP<const Teuchos::ParameterList> getParameterList() const override { return list_; }
  [[nodiscard]] RCP<const Teuchos::ParameterList> getValidParameters() const override;

private:
  RCP<Teuchos::ParameterList> list_;
  linear::FetiDpParameters parameters_;
};

} // namespace epafi::adapters
