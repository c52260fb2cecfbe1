#include "QpProblems.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/constraints/Box.hpp"

#include <Tpetra_MultiVector.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

/// What a user may get wrong: an InputError on every rank, and x as it was.
namespace {

using namespace epafi;
using namespace epafi::test;

/// Solves a sound problem after `spoil`; returns the text of the InputError, which all ranks must throw.
std::string errorOf(const std::function<void(qp::QuadraticProgram&, Vector&)>& spoil, bool hasRows = true) {
  const DenseProgram program = hasRows ? mixedProgramWithRows(12, 3, 10, 83) : mixedProgram(12, 10, 83);
  qp::QuadraticProgram problem = toQuadraticProgram(program);
  Vector x(problem.hessian->getDomainMap());
  spoil(problem, x);
  std::string text = "no error";
  EXPECT_THROW(
      try { qp::QpSolver().solve(problem, x); } catch (const std::exception& error) {
        text = error.what();
        throw;
      },
      InputError)
      << text;
  return text;
}

void expectNamed(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

/// A copy with `value` in entry `index`, which one rank holds.
RCP<Vector> spoilt(const Vector& x, int index, double value) {
  const RCP<Vector> result = rcp(new Vector(x, Teuchos::Copy));
  if (result->getMap()->isNodeGlobalElement(index))
    result->replaceGlobalValue(index, value);
  return result;
}

class QpInputTest : public testing::TestWithParam<double> {};

TEST_P(QpInputTest, TheLinearTermMustBeFinite) {
  const std::string text = errorOf([](qp::QuadraticProgram& problem, Vector&) {
    problem.linearTerm = spoilt(*problem.linearTerm, 11, GetParam());
  });

  expectNamed(text, "entry 11");
  expectNamed(text, "linear term");
}

TEST_P(QpInputTest, TheStartMustBeFinite) {
  const std::string text =
      errorOf([](qp::QuadraticProgram&, Vector& x) { x.assign(*spoilt(x, 0, GetParam())); });

  expectNamed(text, "entry 0");
  expectNamed(text, "start");
}

TEST_P(QpInputTest, TheConstraintValuesMustBeFinite) {
  const std::string text = errorOf([](qp::QuadraticProgram& problem, Vector&) {
    problem.constraintValues = spoilt(*problem.constraintValues, 2, GetParam());
  });

  expectNamed(text, "entry 2");
  expectNamed(text, "constraint values");
}

INSTANTIATE_TEST_SUITE_P(Values, QpInputTest, testing::Values(std::nan(""), unlimited, -unlimited),
                         [](const auto& instance) { return "number" + std::to_string(instance.index); });

TEST(QpInputTest, BoundsMustBeNumbers) {
  for (const bool isLower : {true, false}) {
    const std::string text = errorOf([isLower](qp::QuadraticProgram& problem, Vector& x) {
      const RCP<const Vector> bound = spoilt(x, 7, std::nan(""));
      problem.set = isLower ? rcp(new qp::Box(bound)) : rcp(new qp::Box(Teuchos::null, bound));
    });

    expectNamed(text, "entry 7");
  }
}

TEST(QpInputTest, RowsMustBeFinite) {
  for (const int dense : {300, 0})
    for (const double value : {std::nan(""), unlimited}) {
      DenseProgram program = mixedProgramWithRows(12, 3, 10, 83);
      program.rows(1, 5) = value;
      QpCall call;
      call.parameters.set("Maximum Dense Rows", dense);

      EXPECT_THROW(solveQp(program, call), Error) << value << ", dense rows " << dense;
    }
}

TEST(QpInputTest, HessianAndLinearTermMustBeThere) {
  expectNamed(errorOf([](qp::QuadraticProgram& problem, Vector&) { problem.hessian = Teuchos::null; }),
              "Hessian");
  expectNamed(errorOf([](qp::QuadraticProgram& problem, Vector&) { problem.linearTerm = Teuchos::null; }),
              "linear term");
}

TEST(QpInputTest, EveryVectorMustBeOnTheMapOfTheUnknowns) {
  const RCP<const Map> other = linearMap(13);
  const RCP<Vector> vector = rcp(new Vector(other));

  expectNamed(errorOf([&](qp::QuadraticProgram& problem, Vector&) { problem.linearTerm = vector; }),
              "linear term");
  expectNamed(
      errorOf([&](qp::QuadraticProgram& problem, Vector&) { problem.set = rcp(new qp::Box(vector)); }),
      "bounds");
  expectNamed(errorOf([&](qp::QuadraticProgram& problem, Vector&) { problem.activeGuess = vector; }),
              "guess");
  expectNamed(errorOf([&](qp::QuadraticProgram& problem, Vector&) {
                problem.preconditioner = rcp(new DenseOperator(other, Eigen::MatrixXd::Identity(13, 13)));
              }),
              "preconditioner");
  expectNamed(errorOf([&](qp::QuadraticProgram& problem, Vector&) {
                problem.constraintMatrix =
                    rcp(new DenseRows(other, linearMap(3), Eigen::MatrixXd::Ones(3, 13)));
              }),
              "constraint matrix");
  expectNamed(errorOf([&](qp::QuadraticProgram& problem, Vector&) { problem.constraintValues = vector; }),
              "right-hand side");
}

TEST(QpInputTest, TheCoarseSpaceMustBeOnTheMapOfTheUnknowns) {
  for (const int size : {5, 13})
    expectNamed(errorOf([size](qp::QuadraticProgram& problem,
                               Vector&) { problem.coarseSpace = rcp(new MultiVector(linearMap(size), 1)); },
                        false),
                "coarse space");
}

TEST(QpInputTest, TheStartMustBeOnTheMapOfTheUnknowns) {
  const DenseProgram program = mixedProgram(12, 10, 83);
  Vector x(linearMap(13));

  EXPECT_THROW(qp::QpSolver().solve(toQuadraticProgram(program), x), InputError);
}

TEST(QpInputTest, WhatThePreconditionerOfAFaceReturnsIsCheckedToo) {
  errorOf([](qp::QuadraticProgram& problem, Vector&) {
    problem.facePreconditioner = [](const Vector&) -> RCP<const Operator> {
      return rcp(new DenseOperator(linearMap(13), Eigen::MatrixXd::Identity(13, 13)));
    };
  });
}

TEST(QpInputTest, ValuesWithoutRowsAreRefused) {
  const std::string text =
      errorOf([](qp::QuadraticProgram& problem, Vector&) { problem.constraintMatrix = Teuchos::null; });

  expectNamed(text, "without a constraint matrix");
}

TEST(QpInputTest, ACoarseSpaceGoesWithBoundsAlone) {
  const std::string text = errorOf([](qp::QuadraticProgram& problem, Vector& x) {
    problem.coarseSpace = rcp(new MultiVector(x.getMap(), 1));
  });

  expectNamed(text, "coarse space");
}

TEST(QpInputTest, ACoarseSpaceMustVanishWhereThereIsABound) {
  // Entries 3 and 8 of the mixed program are free of bounds; 0 has two, 1 a lower and 2 an upper one, 4 is
  // fixed.
  for (const int touched : {0, 1, 2, 4}) {
    const std::string text = errorOf(
        [touched](qp::QuadraticProgram& problem, Vector& x) {
          problem.coarseSpace =
              makeVector(x.getMap(), [touched](int i) { return i == 3 || i == touched ? 1.0 : 0.0; });
        },
        false);

    expectNamed(text, "bound");
  }
}

TEST(QpInputTest, ACoarseSpaceMustBeIndependentAndFinite) {
  const auto columns = [](const RCP<const Map>& map, double value) {
    const RCP<MultiVector> u = rcp(new MultiVector(map, 2));
    for (int column = 0; column < 2; ++column)
      if (map->isNodeGlobalElement(3))
        u->replaceGlobalValue(3, static_cast<std::size_t>(column), value);
    return u;
  };
  for (const double value : {1.0, 0.0, std::nan(""), unlimited})
    errorOf(
        [&](qp::QuadraticProgram& problem, Vector& x) { problem.coarseSpace = columns(x.getMap(), value); },
        false);
}

/// Has no transposed apply.
class OneWay final : public Operator {
public:
  explicit OneWay(RCP<const Operator> rows) : rows_(std::move(rows)) {}
  RCP<const Map> getDomainMap() const override { return rows_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return rows_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
             double beta) const override {
    rows_->apply(x, y, mode, alpha, beta);
  }

private:
  RCP<const Operator> rows_;
};

TEST(QpInputTest, RowsMustHaveATransposedApply) {
  const std::string text = errorOf([](qp::QuadraticProgram& problem, Vector&) {
    problem.constraintMatrix = rcp(new OneWay(problem.constraintMatrix));
  });

  expectNamed(text, "transposed");
}

TEST(QpInputTest, ParametersAreCheckedWhenTheSolverIsMade) {
  const auto make = [](const char* sublist, const char* name, const auto& value) {
    Teuchos::ParameterList list;
    (*sublist == '\0' ? list : list.sublist(sublist)).set(name, value);
    const qp::QpSolver solver(list);
  };

  EXPECT_THROW(make("", "Tolerance", -1e-6), InputError);
  EXPECT_THROW(make("", "Tolerance", std::nan("")), InputError);
  EXPECT_THROW(make("", "Tolerence", 1e-6), InputError);
  EXPECT_THROW(make("", "Operator Norm", -1.0), InputError);
  EXPECT_THROW(make("", "Maximum Dense Rows", -1), InputError);
  EXPECT_THROW(make("MPRGP", "Expansion", std::string("sideways")), InputError);
  EXPECT_THROW(make("MPRGP", "Expansion Step", 2.0), InputError);
  EXPECT_THROW(make("MPRGP", "Proportioning Constant", -1.0), InputError);
  EXPECT_THROW(make("SMALBE", "Update", std::string("neither")), InputError);
  EXPECT_NO_THROW(qp::QpSolver{qp::QpSolver::validParameters()});
}

TEST(QpInputTest, EveryParameterHasItsMeaningInTheList) {
  const Teuchos::ParameterList list = qp::QpSolver::validParameters();
  for (const char* sublist : {"MPRGP", "SMALBE", "Norm Estimate"}) {
    ASSERT_TRUE(list.isSublist(sublist));
    for (const auto& item : list.sublist(sublist))
      EXPECT_FALSE(item.second.docString().empty()) << item.first;
  }
}

} // namespace
