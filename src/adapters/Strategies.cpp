#include "epafi/adapters/Stratimikos.hpp"

#include "epafi/adapters/BddcFactory.hpp"
#include "epafi/adapters/FetiDpFactory.hpp"

#include <Teuchos_AbstractFactoryStd.hpp>

#include <utility>

namespace epafi::adapters {
namespace {

class BddcFactories final : public Teuchos::AbstractFactory<PreconditioningStrategy> {
public:
  explicit BddcFactories(RCP<const linear::UnassembledOperator> k) : k_(std::move(k)) {}
  [[nodiscard]] obj_ptr_t create() const override { return rcp(new BddcFactory(k_)); }

private:
  RCP<const linear::UnassembledOperator> k_;
};

} // namespace

RCP<const Teuchos::AbstractFactory<LinearSolveStrategy>> fetiDpStrategy() {
  return Teuchos::abstractFactoryStd<LinearSolveStrategy, FetiDpFactory>();
}

RCP<const Teuchos::AbstractFactory<PreconditioningStrategy>>
bddcStrategy(const RCP<const linear::UnassembledOperator>& k) {
  return rcp(new BddcFactories(k));
}

} // namespace epafi::adapters
