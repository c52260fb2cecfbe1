#pragma once

/// Epafi among the linear solvers and preconditioners that Stratimikos picks by name from a parameter list.
/// Needs no more than C++17: g++ up to 13 does not take the header of DefaultLinearSolverBuilder in Trilinos
/// 13.2 as C++20. A file in C++20 takes linearSolveStrategy.

#include "epafi/base/StratimikosCompatibility.hpp"
#include "epafi/base/Types.hpp"

#include <Teuchos_AbstractFactory.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Thyra_LinearOpWithSolveFactoryBase_decl.hpp>
#include <Thyra_PreconditionerFactoryBase_decl.hpp>

#include <string>

namespace epafi::linear {
class UnassembledOperator;
} // namespace epafi::linear

namespace epafi::adapters {

using LinearSolveStrategy = Thyra::LinearOpWithSolveFactoryBase<double>;
using PreconditioningStrategy = Thyra::PreconditionerFactoryBase<double>;

/// Makes FetiDpFactory.
RCP<const Teuchos::AbstractFactory<LinearSolveStrategy>> fetiDpStrategy();

/// Makes BddcFactory(k). \param k  may be null
RCP<const Teuchos::AbstractFactory<PreconditioningStrategy>>
bddcStrategy(const RCP<const linear::UnassembledOperator>& k);

/// From now on "Linear Solver Type" = `name` is FetiDpFactory, with its parameters in the list "Linear Solver
/// Types/`name`". Precondition: the builder has no parameters yet. Not collective.
void enableFetiDp(Stratimikos::DefaultLinearSolverBuilder& builder,
                  const std::string& name = "Epafi FETI-DP");

/// "Preconditioner Type" = `name` is BddcFactory(k), with its parameters in "Preconditioner Types/`name`";
/// likewise.
/// \param k  the decomposition of forward operators that are assembled; null if they are UnassembledOperators
/// themselves
void enableBddc(Stratimikos::DefaultLinearSolverBuilder& builder,
                const RCP<const linear::UnassembledOperator>& k = Teuchos::null,
                const std::string& name = "Epafi BDDC");

/// The solver that a list for Stratimikos asks for, Epafi's two among those it may name; `k` as above. The
/// list is kept.
/// \throws InputError, or Teuchos's exceptions, where a parameter is wrong. Not collective.
RCP<LinearSolveStrategy> linearSolveStrategy(const RCP<Teuchos::ParameterList>& list,
                                             const RCP<const linear::UnassembledOperator>& k = Teuchos::null);

} // namespace epafi::adapters
