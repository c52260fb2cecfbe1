#pragma once

/// K and its solution by FETI-DP as Thyra sees them. Made by FetiDpFactory.

#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/linear/FetiDpSolver.hpp"

#include <Thyra_LinearOpWithSolveBase_decl.hpp>

#include <memory>

namespace epafi::adapters {

/// a K, symmetric, so that transposes are the same. As Thyra has it, one that is not initialised has no
/// range.
class FetiDpSolve final : public Thyra::LinearOpWithSolveBase<double> {
public:
  /// Factorises; for the same K and parameters as before, whose matrices may have changed, what still holds
  /// is kept. Collective.
  /// \throws what linear::FetiDpSolver throws
  void initialize(const RCP<const Thyra::LinearOpSourceBase<double>>& source,
                  const linear::FetiDpParameters& parameters);
  /// Gives the source back and forgets the factors. Not collective.
  RCP<const Thyra::LinearOpSourceBase<double>> uninitialize();

  [[nodiscard]] RCP<const Thyra::VectorSpaceBase<double>> range() const override;
  [[nodiscard]] RCP<const Thyra::VectorSpaceBase<double>> domain() const override;
  [[nodiscard]] std::string description() const override;
  /// Null without initialize.
  [[nodiscard]] const std::shared_ptr<linear::FetiDpSolver>& solver() const { return solver_; }

protected:
  [[nodiscard]] bool opSupportedImpl(Thyra::EOpTransp transposition) const override;
  void applyImpl(Thyra::EOpTransp transposition, const Thyra::MultiVectorBase<double>& x,
                 const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& y, double alpha,
                 double beta) const override;
  [[nodiscard]] bool solveSupportsImpl(Thyra::EOpTransp transposition) const override;
  [[nodiscard]] bool
  solveSupportsNewImpl(Thyra::EOpTransp transposition,
                       Teuchos::Ptr<const Thyra::SolveCriteria<double>> criteria) const override;
  [[nodiscard]] bool solveSupportsSolveMeasureTypeImpl(Thyra::EOpTransp transposition,
                                                       const Thyra::SolveMeasureType& measure) const override;
  /// Residuals relative to the right-hand side (default) or to the start residual; the tolerance asked for,
  /// or that of the parameters. `achievedTol` is the largest of the columns', computed afresh;
  /// `extraParameters` has "Iteration Count". Collective. \throws InputError, the same on all ranks, for
  /// other measures.
  Thyra::SolveStatus<double>
  solveImpl(Thyra::EOpTransp transposition, const Thyra::MultiVectorBase<double>& b,
            const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& x,
            Teuchos::Ptr<const Thyra::SolveCriteria<double>> criteria) const override;

private:
  RCP<const Thyra::LinearOpSourceBase<double>> source_;
  ForwardOperator forward_;
  std::shared_ptr<linear::FetiDpSolver> solver_;
};

} // namespace epafi::adapters
