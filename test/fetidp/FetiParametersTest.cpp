#include "support/Reference.hpp"

#include "support/Refusal.hpp"

#include "epafi/direct/SpdFactor.hpp"
#include "epafi/fetidp/operator/FetiParameters.hpp"

#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

/// What a solver says to one parameter of one list.
template <class T>
std::string complaint(const std::string& sublist, const std::string& name, const T& value) {
  Teuchos::ParameterList list;
  list.sublist(sublist).set(name, value);
  return test::refusal([&] { ContactSolver{list}; });
}

TEST(FetiParametersTest, WordsThatMeanNothingAreRefusedWithThoseThatDo) {
  using Text = std::string;
  test::expectSays(complaint("Direct Solvers", "Subdomains", Text("KLU3")),
                   {"Subdomains", "KLU3", "KLU2", "CHOLMOD", "auto"});
  test::expectSays(complaint("Direct Solvers", "Coarse Problem", Text("LU")),
                   {"Coarse Problem", "LU", "KLU2", "CHOLMOD", "auto"});
  test::expectSays(complaint("Direct Solvers", "Share Identical Subdomains", Text("maybe")),
                   {"Share Identical Subdomains", "maybe", "yes", "no"});
  test::expectSays(complaint("Dual Operator", "Mode", Text("dense")),
                   {"Mode", "dense", "auto", "implicit", "explicit"});
  test::expectSays(complaint("Preconditioner", "Type", Text("Neumann")),
                   {"Type", "Neumann", "none", "lumped", "dirichlet"});
  test::expectSays(complaint("Preconditioner", "Scaling", Text("none")),
                   {"Scaling", "none", "multiplicity", "stiffness"});
  test::expectSays(complaint("Preconditioner", "Precision", Text("half")),
                   {"Precision", "half", "single", "double"});
}

TEST(FetiParametersTest, NumbersOutOfRangeTypesAndNamesAreRefused) {
  test::expectSays(complaint("Dual Operator", "Expected Products", 0), {"Expected Products", "0", "1"});
  test::expectSays(complaint("Dual Operator", "Expected Products", -5), {"Expected Products", "-5"});
  test::expectSays(complaint("Dual Operator", "Expected Products", 2.5), {"Expected Products"});
  test::expectSays(complaint("Direct Solvers", "Share Identical Subdomains", true),
                   {"Share Identical Subdomains"});
  test::expectSays(complaint("Preconditioner", "Scalings", std::string("stiffness")),
                   {"Scalings", "Scaling"});
  test::expectSays(complaint("Dual Operators", "Mode", std::string("auto")),
                   {"Dual Operators", "Dual Operator"});
}

TEST(FetiParametersTest, DefaultsOfTheListAreThoseOfTheStructs) {
  Teuchos::ParameterList list;
  addFetiParameters(list);
  const DirectSolvers solvers = directSolversFrom(list.sublist("Direct Solvers"));
  EXPECT_EQ(solvers.subdomains, DirectSolvers().subdomains);
  EXPECT_EQ(solvers.coarse, DirectSolvers().coarse);
  EXPECT_EQ(solvers.shareIdentical, DirectSolvers().shareIdentical);
  const DualOperatorParameters dual = dualOperatorFrom(list.sublist("Dual Operator"));
  EXPECT_EQ(dual.mode, DualOperatorParameters().mode);
  EXPECT_EQ(dual.expectedProducts, DualOperatorParameters().expectedProducts);
  const PreconditionerParameters preconditioner = preconditionerFrom(list.sublist("Preconditioner"));
  EXPECT_EQ(preconditioner.type, PreconditionerParameters().type);
  EXPECT_EQ(preconditioner.scaling, PreconditionerParameters().scaling);
  EXPECT_EQ(preconditioner.isSingle, PreconditionerParameters().isSingle);
}

TEST(FetiParametersTest, WhatIsSaidArrives) {
  Teuchos::ParameterList list;
  addFetiParameters(list);
  for (const std::string& name : direct::availableSolvers()) {
    list.sublist("Direct Solvers").set("Subdomains", name).set("Coarse Problem", name);
    EXPECT_EQ(directSolversFrom(list.sublist("Direct Solvers")).subdomains, name);
    EXPECT_EQ(directSolversFrom(list.sublist("Direct Solvers")).coarse, name);
  }
  list.sublist("Direct Solvers").set("Share Identical Subdomains", "no");
  EXPECT_FALSE(directSolversFrom(list.sublist("Direct Solvers")).shareIdentical);

  using Mode = DualOperatorParameters::Mode;
  Teuchos::ParameterList& dual = list.sublist("Dual Operator").set("Expected Products", 7);
  EXPECT_EQ(dualOperatorFrom(dual).expectedProducts, 7);
  EXPECT_EQ(dualOperatorFrom(dual.set("Mode", "implicit")).mode, Mode::implicitSolves);
  EXPECT_EQ(dualOperatorFrom(dual.set("Mode", "explicit")).mode, Mode::explicitBlocks);
  EXPECT_EQ(dualOperatorFrom(dual.set("Mode", "auto")).mode, Mode::automatic);

  using P = PreconditionerParameters;
  Teuchos::ParameterList& m = list.sublist("Preconditioner");
  EXPECT_EQ(preconditionerFrom(m.set("Type", "none")).type, P::Type::none);
  EXPECT_EQ(preconditionerFrom(m.set("Type", "lumped")).type, P::Type::lumped);
  EXPECT_EQ(preconditionerFrom(m.set("Type", "dirichlet")).type, P::Type::dirichlet);
  EXPECT_EQ(preconditionerFrom(m.set("Scaling", "multiplicity")).scaling, P::Scaling::multiplicity);
  EXPECT_TRUE(preconditionerFrom(m.set("Precision", "single")).isSingle);
  EXPECT_EQ(describe(preconditionerFrom(m)), "dirichlet, multiplicity scaling, single precision");
  EXPECT_EQ(describe(preconditionerFrom(m.set("Type", "none"))), "none");
}

TEST(FetiParametersTest, AutoIsASolverThatThereIs) {
  Teuchos::ParameterList list;
  addFetiParameters(list);
  const std::vector<std::string> known = direct::availableSolvers();
  const DirectSolvers solvers = directSolversFrom(list.sublist("Direct Solvers"));
  for (const std::string& name : {solvers.subdomains, solvers.coarse}) {
    EXPECT_NE(name, "auto");
    EXPECT_EQ(std::count(known.begin(), known.end(), name), 1) << name;
  }
}

/// What a solve with these parameters was.
SolveFacts factsOf(const scene::Scene& scene, const Teuchos::ParameterList& parameters) {
  const auto decomposition = decompose(scene, world());
  ContactSolver solver(parameters);
  solver.setup(decomposition.problem, decomposition.data);
  solver.solve(decomposition.data);
  return solver.facts();
}

TEST(FetiParametersTest, TheReportSaysWhatWasDone) {
  const scene::Scene scene = twoMembranes(true, 12, grid(4, 4));
  Teuchos::ParameterList list;
  list.sublist("Direct Solvers").set("Subdomains", "KLU2");
  list.sublist("Dual Operator").set("Mode", "explicit");
  list.sublist("Preconditioner")
      .set("Type", "lumped")
      .set("Scaling", "multiplicity")
      .set("Precision", "single");
  SolveFacts said = factsOf(scene, list);
  EXPECT_EQ(said.subdomainSolver, "KLU2");
  EXPECT_EQ(said.coarseSolver, direct::fastestSolver());
  EXPECT_EQ(said.preconditioner, "lumped, multiplicity scaling, single precision");
  test::expectSays(said.dualOperator, {"explicit, ", "factorisations, the others alike"});

  list.sublist("Dual Operator").set("Mode", "implicit");
  list.sublist("Preconditioner").set("Type", "none");
  list.sublist("Direct Solvers").set("Share Identical Subdomains", "no");
  said = factsOf(scene, list);
  EXPECT_EQ(said.preconditioner, "none");
  EXPECT_EQ(said.dualOperator, "implicit");

  said = factsOf(decomposition::oneBody(3, 3, grid(1, 1), {{"wall", "left", {0.0}}}), list);
  EXPECT_EQ(said.dualOperator, "none");
}

} // namespace
} // namespace epafi::fetidp
