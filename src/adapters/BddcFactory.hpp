#pragma once

/// BDDC as one of the preconditioners that Thyra knows.

#include "epafi/linear/LinearParameters.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <Thyra_PreconditionerFactoryBase_decl.hpp>

namespace epafi::adapters {

/// Makes linear::BddcPreconditioner. The decomposition comes from the forward operator if that is asThyra(UnassembledOperator), or
/// from the operator that the factory was given, whose K is then taken for the forward operator's, an assembled matrix on the same
/// map, say. Parameters: BddcParameters::validParameters, and the list "VerboseObject" that Thyra's factories have.
class BddcFactory final : public Thyra::PreconditionerFactoryBase<double> {
public:
  /// \param k  for forward operators that are assembled; may be null
  explicit BddcFactory(RCP<const linear::UnassembledOperator> k = Teuchos::null);

  [[nodiscard]] bool isCompatible(const Thyra::LinearOpSourceBase<double>& source) const override;
  [[nodiscard]] RCP<Thyra::PreconditionerBase<double>> createPrec() const override;
  /// Factorises. Collective. \throws what linear::BddcPreconditioner throws; InputError if the operator is not compatible
  void initializePrec(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                      Thyra::PreconditionerBase<double>* preconditioner,
                      Thyra::ESupportSolveUse use = Thyra::SUPPORT_SOLVE_UNSPECIFIED) const override;
  void uninitializePrec(Thyra::PreconditionerBase<double>* preconditioner,
                        RCP<const Thyra::LinearOpSourceBase<double>>* source = nullptr,
                        Thyra::ESupportSolveUse* use = nullptr) const override;
  [[nodiscard]] std::string description() const override { return "Epafi BDDC"; }

  /// \throws InputError that names list, parameter, value and what is allowed
  void setParameterList(const RCP<Teuchos::ParameterList>& list) override;
  [[nodiscard]] RCP<Teuchos::ParameterList> getNonconstParameterList() override { return list_; }
  [[nodiscard]] RCP<Teuchos::ParameterList> unsetParameterList() override;
  [[nodiscard]] RCP<const Teuchos::ParameterList> getParameterList() const override { return list_; }
  [[nodiscard]] RCP<const Teuchos::ParameterList> getValidParameters() const override;

private:
  [[nodiscard]] RCP<const linear::UnassembledOperator>
  decompositionOf(const Thyra::LinearOpSourceBase<double>& source, double& factor) const;

  RCP<const linear::UnassembledOperator> k_;
  RCP<Teuchos::ParameterList> list_;
  linear::BddcParameters parameters_;
};

} // namespace epafi::adapters
