#pragma once

/// BDDC as one of the preconditioners that Thyra knows.

#include "epafi/adapters/ConfiguredFactory.hpp"
#include "epafi/linear/LinearParameters.hpp"
#include "epafi/linear/UnassembledOperator.hpp"

#include <Thyra_PreconditionerFactoryBase_decl.hpp>

namespace epafi::adapters {

/// Makes linear::BddcPreconditioner. The decomposition comes from the forward operator if that is
/// asThyra(UnassembledOperator), or from the operator that the factory was given, whose K is then taken for
/// the forward operator's, an assembled matrix on the same map, say.
class BddcFactory final
    : public ConfiguredFactory<Thyra::PreconditionerFactoryBase<double>, linear::BddcParameters> {
public:
  /// \param k  for forward operators that are assembled; may be null
  explicit BddcFactory(RCP<const linear::UnassembledOperator> k = Teuchos::null);

  [[nodiscard]] bool isCompatible(const Thyra::LinearOpSourceBase<double>& source) const override;
  [[nodiscard]] RCP<Thyra::PreconditionerBase<double>> createPrec() const override;
  /// Factorises. Collective. \throws what linear::BddcPreconditioner throws; InputError if the operator is
  /// not compatible
  void initializePrec(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                      Thyra::PreconditionerBase<double>* preconditioner,
                      Thyra::ESupportSolveUse use = Thyra::SUPPORT_SOLVE_UNSPECIFIED) const override;
  void uninitializePrec(Thyra::PreconditionerBase<double>* preconditioner,
                        RCP<const Thyra::LinearOpSourceBase<double>>* source = nullptr,
                        Thyra::ESupportSolveUse* use = nullptr) const override;

private:
  [[nodiscard]] RCP<const linear::UnassembledOperator>
  decompositionOf(const Thyra::LinearOpSourceBase<double>& source, double& factor) const;

  RCP<const linear::UnassembledOperator> k_;
};

} // namespace epafi::adapters
