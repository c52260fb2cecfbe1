#include "epafi/thyra/Stratimikos.hpp"

#include "epafi/thyra/BddcFactory.hpp"
#include "epafi/thyra/FetiDpFactory.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Teuchos_AbstractFactoryStd.hpp>

#include <utility>

namespace epafi::thyra {
namespace {

using PreconditionerFactory = Thyra::PreconditionerFactoryBase<double>;

/// Makes BddcFactory(k).
class BddcFactories final : public Teuchos::AbstractFactory<PreconditionerFactory> {
public:
  explicit BddcFactories(RCP<const linear::UnassembledOperator> k) : k_(std::move(k)) {}
  [[nodiscard]] obj_ptr_t create() const override { return rcp(new BddcFactory(k_)); }

private:
  RCP<const linear::UnassembledOperator> k_;
};

} // namespace

void enableFetiDp(Stratimikos::DefaultLinearSolverBuilder& builder, const std::string& name) {
  builder.setLinearSolveStrategyFactory(
      Teuchos::abstractFactoryStd<Thyra::LinearOpWithSolveFactoryBase<double>, FetiDpFactory>(), name);
}

void enableBddc(Stratimikos::DefaultLinearSolverBuilder& builder,
                const RCP<const linear::UnassembledOperator>& k, const std::string& name) {
  builder.setPreconditioningStrategyFactory(rcp(new BddcFactories(k)), name);
}

} // namespace epafi::thyra
