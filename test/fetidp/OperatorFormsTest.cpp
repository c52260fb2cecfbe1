// F in all its forms: sparse solves or dense blocks, factors shared or not, by any direct solver.

#include "support/Preconditioned.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

using Mode = DualOperatorParameters::Mode;

struct Form {
  std::string solver;
  bool isShared;
  Mode mode;
};

std::vector<Form> allForms() {
  std::vector<Form> forms;
  for (const std::string& solver : direct::availableSolvers())
    for (const bool isShared : {true, false})
      for (const Mode mode : {Mode::implicitSolves, Mode::explicitBlocks, Mode::automatic})
        forms.push_back({solver, isShared, mode});
  return forms;
}

std::string nameOfForm(const Form& form) {
  return form.solver + (form.isShared ? ", shared" : ", not shared") +
         (form.mode == Mode::implicitSolves   ? ", implicit"
          : form.mode == Mode::explicitBlocks ? ", explicit"
                                              : ", auto");
}

/// Cases with equal subdomains in number, and METIS parts.
std::vector<ContactCase> formCases() {
  std::vector<ContactCase> cases;
  for (const bool coercive : {true, false}) {
    const std::string kind = coercive ? "coercive, " : "semicoercive, ";
    cases.push_back({kind + "grid", twoMembranes(coercive, 12, grid(4, 4)), coercive});
    cases.push_back({kind + "METIS", twoMembranes(coercive, 8, metis(5)), coercive});
    cases.push_back({kind + "one element a subdomain", twoMembranes(coercive, 3, grid(3, 3)), coercive});
  }
  return cases;
}

/// F of a problem in one form.
Eigen::MatrixXd matrixIn(const DecomposedProblem& problem, const Form& form) {
  auto inverse =
      std::make_shared<GeneralizedInverse>(problem, DirectSolvers{form.solver, "CHOLMOD", form.isShared});
  inverse->prepareDual({form.mode, 40});
  return matrixOf(DualOperator(std::move(inverse)));
}

TEST(OperatorFormsTest, EveryFormEqualsTheUndecomposedComputation) {
  for (const ContactCase& c : formCases()) {
    const auto decomposition = decompose(c.scene, world());
    const DenseProblem dense = densify(decomposition.problem);
    const Eigen::MatrixXd z = kernelOf(dense.constraint * dense.kernel);
    const Eigen::MatrixXd expected =
        z.transpose() * dense.constraint * pseudoInverse(dense.stiffness) * dense.constraint.transpose() * z;
    for (const Form& form : allForms()) {
      SCOPED_TRACE(c.name + "; " + nameOfForm(form));
      EXPECT_LE(relativeError(z.transpose() * matrixIn(decomposition.problem, form) * z, expected), 1e-12);
    }
  }
}

/// On all multipliers, where bodies float too: one generalised inverse is used by all.
TEST(OperatorFormsTest, AllFormsAreTheSameOperator) {
  for (const ContactCase& c : formCases()) {
    const auto decomposition = decompose(c.scene, world());
    const Eigen::MatrixXd plain = matrixIn(decomposition.problem, {"CHOLMOD", false, Mode::implicitSolves});
    for (const Form& form : allForms()) {
      SCOPED_TRACE(c.name + "; " + nameOfForm(form));
      const Eigen::MatrixXd f = matrixIn(decomposition.problem, form);
      EXPECT_LE(relativeError(f, plain), 1e-12);
      EXPECT_LE((f - f.transpose()).norm(), 1e-13 * f.norm());
    }
  }
}

TEST(OperatorFormsTest, EveryFormIsTheSameToTheLastDigitOnAnyNumberOfRanks) {
  for (const ContactCase& c : formCases()) {
    const auto together = decompose(c.scene, world()), alone = decompose(c.scene, thisRankOnly());
    for (const Form& form : allForms()) {
      SCOPED_TRACE(c.name + "; " + nameOfForm(form));
      EXPECT_EQ((matrixIn(together.problem, form) - matrixIn(alone.problem, form)).cwiseAbs().maxCoeff(), 0);
    }
  }
}

/// M by blocks of full precision or by the factors alone, where F has no block.
TEST(OperatorFormsTest, AllFormsAreTheSamePreconditioner) {
  const auto matrixOfM = [](const DecomposedProblem& problem, const Form& form) {
    auto inverse =
        std::make_shared<GeneralizedInverse>(problem, DirectSolvers{form.solver, "CHOLMOD", form.isShared});
    inverse->prepareDual({form.mode, 40});
    const DualPreconditioner m(problem, inverse, PreconditionerParameters{});
    return matrixOf(m);
  };
  for (const ContactCase& c : formCases()) {
    const auto together = decompose(c.scene, world()), alone = decompose(c.scene, thisRankOnly());
    const Eigen::MatrixXd blocks = matrixOfM(together.problem, {"CHOLMOD", false, Mode::explicitBlocks});
    for (const Form& form : allForms()) {
      SCOPED_TRACE(c.name + "; " + nameOfForm(form));
      const Eigen::MatrixXd m = matrixOfM(together.problem, form);
      EXPECT_LE(relativeError(m, blocks), 1e-12);
      EXPECT_LE((m - m.transpose()).norm(), 1e-13 * m.norm());
      EXPECT_EQ((m - matrixOfM(alone.problem, form)).cwiseAbs().maxCoeff(), 0);
    }
  }
}

/// A group's columns do not disturb each other: F of many multipliers at once and one after the other.
TEST(OperatorFormsTest, ProductsWithManyMultipliersAtOnceAreTheSumOfSingleOnes) {
  const auto decomposition = decompose(twoMembranes(false, 12, grid(4, 4)), world());
  const DecomposedProblem& problem = decomposition.problem;
  for (const Form& form : allForms()) {
    SCOPED_TRACE(nameOfForm(form));
    auto inverse =
        std::make_shared<GeneralizedInverse>(problem, DirectSolvers{form.solver, "CHOLMOD", form.isShared});
    inverse->prepareDual({form.mode, 40});
    const DualOperator f(inverse);
    const Eigen::MatrixXd matrix = matrixOf(f);
    const Eigen::VectorXd x = randomVector(matrix.cols(), 5);
    Vector image(problem.multiplierMap);
    f.apply(*spread(problem.multiplierMap, x), image);
    EXPECT_LE(relativeError(gathered(image), matrix * x), 1e-13);
  }
}

TEST(OperatorFormsTest, OneFactorServesAllThatAreIdentical) {
  const auto decomposition = decompose(twoMembranes(false, 12, grid(4, 4)), thisRankOnly());
  const GeneralizedInverse shared(decomposition.problem, DirectSolvers{"CHOLMOD", "CHOLMOD", true});
  const GeneralizedInverse single(decomposition.problem, DirectSolvers{"CHOLMOD", "CHOLMOD", false});
  EXPECT_EQ(single.groups().size(), 32U);
  EXPECT_LE(shared.groups().size(), 18U); // nine kinds a body at most
  EXPECT_LT(shared.factorBytes(), single.factorBytes());
}

} // namespace
} // namespace epafi::fetidp
