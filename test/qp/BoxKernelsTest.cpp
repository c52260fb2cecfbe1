#include "support/Problems.hpp"

#include "epafi/qp/constraints/Box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

/// The passes of Box over its vectors, each alone: two-sided, lower, upper, no bounds and a fixed entry in
/// turn.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Box;

/// Entries 0 … 6: [−1, 2], [−1, ∞), (−∞, 2], free, fixed at 1, [−1, 2], [−1, 2].
class BoxKernelsTest : public testing::Test {
protected:
  static RCP<Vector> vector(const std::vector<double>& values) {
    return makeVector(linearMap(7), [&](int i) { return values[i]; });
  }
  static Eigen::VectorXd dense(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }
  static double smallest(double mine) { // over the ranks
    double result = 0;
    Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_MIN, 1, &mine, &result);
    return result;
  }
  static double largest(double mine) { return -smallest(-mine); }

  RCP<Vector> lower_ = vector({-1, -1, -test::unbounded, -test::unbounded, 1, -1, -1});
  RCP<Vector> upper_ = vector({2, test::unbounded, 2, test::unbounded, 1, 2, 2});
  Box box_{lower_, upper_};
  RCP<Vector> x_ = vector({-1, -1, 2, 5, 1, 2, 0.5}); ///< lower, lower, upper, free, fixed, upper, free
};

TEST_F(BoxKernelsTest, MoveGoesAlongAndProjects) {
  box_.move(2, *vector({-0.5, 3, 1, 4, -1, -1, 0.25}), *x_);

  EXPECT_EQ(gather(*x_), dense({0, -1, 0, -3, 1, 2, 0}));
}

TEST_F(BoxKernelsTest, MoveByNothingStays) {
  box_.move(0, *vector({1, 1, 1, 1, 1, 1, 1}), *x_);

  EXPECT_EQ(gather(*x_), dense({-1, -1, 2, 5, 1, 2, 0.5}));
}

TEST_F(BoxKernelsTest, TheLongestStepEndsAtTheFirstBound) {
  const auto along = [&](const std::vector<double>& p) {
    return smallest(box_.maxFeasibleStep(*x_, *vector(p)));
  };

  EXPECT_EQ(along({0, 0, 0, 0, 0, 0, 0.5}), 3) << "from 0.5 to −1";
  EXPECT_EQ(along({0, 0, 0, 0, 0, 0, -0.5}), 3) << "from 0.5 to 2";
  EXPECT_EQ(along({0, 0, 0, 7, 0, 0, 0}), test::unbounded);
  EXPECT_EQ(along({-1, 0, 0, 0, 0, 0, 0}), 3) << "from the lower bound to the upper one";
  EXPECT_EQ(along({1, 0, 0, 0, 0, 0, 0}), 0) << "out of the box";
  EXPECT_EQ(along({0, -1, 1, 0, 0, 0, 0}), test::unbounded) << "away from single bounds";
  EXPECT_EQ(along({0, 0, 0, 0, 1, 0, 0}), 0) << "a fixed entry";
}

TEST_F(BoxKernelsTest, TheGradientIsSplit) {
  const RCP<Vector> g = vector({-3, 3, 4, 5, 6, -7, 8}), y = vector({9, 9, 9, 9, 9, 9, 9});

  box_.choppedGradient(*x_, *g, 0, *y);
  EXPECT_EQ(gather(*y), dense({-3, 0, 4, 0, 0, 0, 0}));
  box_.projectedGradient(*x_, *g, 0, *y);
  EXPECT_EQ(gather(*y), dense({-3, 0, 4, 5, 0, 0, 8}));
  box_.subtractFromFreeGradient(*x_, *g, 0, *y);
  EXPECT_EQ(gather(*y), dense({0, 0, 0, 5, 0, 0, 8}));
  box_.freeIndicator(*x_, *y);
  EXPECT_EQ(gather(*y), dense({0, 0, 0, 1, 0, 0, 1}));
}

TEST_F(BoxKernelsTest, WithFactorZeroTheOldVectorIsNotRead) {
  const RCP<Vector> y = makeVector(linearMap(7), [](int) { return std::nan(""); });

  box_.subtractFromFreeGradient(*x_, *vector({1, 1, 1, 1, 1, 1, 1}), 0, *y);

  EXPECT_EQ(gather(*y), dense({0, 0, 0, 1, 0, 0, 1}));
}

TEST_F(BoxKernelsTest, TheOldVectorIsSubtractedWithItsFactor) {
  const RCP<Vector> y = vector({1, 2, 3, 4, 5, 6, 7});

  box_.subtractFromFreeGradient(*x_, *vector({1, 1, 1, 1, 1, 1, 1}), 2, *y);

  EXPECT_EQ(gather(*y), dense({-2, -4, -6, -7, -10, -12, -13}));
}

TEST_F(BoxKernelsTest, MeasureSumsWhatTheOthersMake) {
  const RCP<Vector> g = vector({-3, 3, 4, 5, 6, -7, 8}), image = vector({1, 1, 1, 2, 1, 1, 3});
  const double step = 0.5;

  qp::GradientSums sums = box_.measure(*x_, *g, *image, step);
  const double mine[] = {sums.freeSquared.value(),      sums.choppedSquared.value(),
                         sums.reducedTimesFree.value(), sums.freeTimesImage.value(),
                         sums.solutionSquared.value(),  static_cast<double>(sums.active)};
  double all[6];
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_SUM, 6, mine, all);

  EXPECT_EQ(all[0], 25 + 64);
  EXPECT_EQ(all[1], 9 + 16);
  EXPECT_EQ(all[2], 25 + 8 * 3) << "the last one is cut to (0.5 + 1)/0.5 = 3";
  EXPECT_EQ(all[3], 10 + 24);
  EXPECT_EQ(all[4], 1 + 1 + 4 + 25 + 1 + 4 + 0.25);
  EXPECT_EQ(all[5], 5);
}

TEST_F(BoxKernelsTest, RestrictionToTheFreeEntriesClearsTheOthers) {
  const RCP<Vector> z = vector({1, 2, 3, 4, 5, 6, 7});

  box_.restrictToFree(*x_, *z);

  EXPECT_EQ(gather(*z), dense({0, 0, 0, 4, 0, 0, 7}));
}

TEST_F(BoxKernelsTest, ReleasedEntriesKeepADirectionThatEntersTheBox) {
  // x − αz enters at a lower bound with z < 0, at an upper one with z > 0, and only where β ≠ 0.
  const RCP<Vector> g = vector({-3, -3, 4, 5, 6, -7, 8});
  const auto restricted = [&](const std::vector<double>& values) {
    const RCP<Vector> z = vector(values);
    box_.restrictToReleased(*x_, *g, 0, *z);
    return gather(*z);
  };

  EXPECT_EQ(restricted({-1, 1, 1, 1, 1, 1, -1}), dense({-1, 0, 1, 1, 0, 0, -1}));
  EXPECT_EQ(restricted({1, -1, -1, -1, -1, -1, 1}), dense({0, -1, 0, -1, 0, 0, 1}));
}

TEST_F(BoxKernelsTest, TheDistanceIsThatToTheNearerBoundAtMostWhatIsAsked) {
  const RCP<Vector> y = vector({9, 9, 9, 9, 9, 9, 9});
  const RCP<Vector> inside = vector({0, 3, -1, 5, 1, 1.75, 0.5});

  box_.distanceToBoundary(*inside, 3, *y);
  EXPECT_EQ(gather(*y), dense({1, 3, 3, 3, 0, 0.25, 1.5}));
  box_.distanceToBoundary(*x_, test::unbounded, *y);
  EXPECT_EQ(gather(*y), dense({0, 0, 0, test::unbounded, 0, 0, 1.5}));
}

TEST_F(BoxKernelsTest, ActivationGoesToTheNearerBoundIfThereIsOne) {
  const RCP<Vector> inside = vector({0, 3, -9, 5, 1, 1, 1.5});

  box_.activate(*vector({1, 1, -1, 1, 1, 0, 0.5}), *inside);

  EXPECT_EQ(gather(*inside), dense({-1, -1, 2, 5, 1, 1, 2}));
}

TEST_F(BoxKernelsTest, ComplementarityIsTheLargestGradientWithRoom) {
  const auto of = [&](const std::vector<double>& g, double scale) {
    return largest(box_.complementarity(*x_, *vector(g), scale));
  };

  EXPECT_EQ(of({3, 2, -1, 0, 5, -6, 0}, 10), 0) << "every gradient is held by a bound";
  EXPECT_EQ(of({-3, 0, 0, 0, 0, 0, 0}, 10), 3) << "from its lower bound the entry may follow −g";
  EXPECT_EQ(of({-3, 0, 0, 0, 0, 0, 0}, 0.5), 1.5) << "by 3 at most";
  EXPECT_EQ(of({0, 0, 0, -4, 0, 0, 0}, 1), 4) << "no bound at all";
  EXPECT_EQ(of({0, 0, 0, 0, 0, 0, 8}, 2), 3) << "0.5 is 1.5 above its bound";
  EXPECT_EQ(of({0, 0, 0, 0, 7, 0, 0}, 1), 0) << "a fixed entry has no room";
}

TEST_F(BoxKernelsTest, ComplementarityOfAZeroOperatorWithoutBoundsIsZeroOrTheGradientButNoNan) {
  const Box none;
  const RCP<Vector> g = vector({0, 0, 0, 2, 0, 0, 0});

  const double found = largest(none.complementarity(*x_, *g, 0));

  EXPECT_FALSE(std::isnan(found));
}

TEST_F(BoxKernelsTest, MultipliersMayMoveUntilTheFirstChangesItsSign) {
  const RCP<Vector> g = vector({3, 2, -1, 0, 5, -6, 0}); // ≥ 0 at lower bounds, ≤ 0 at upper ones
  const auto along = [&](const std::vector<double>& s) {
    return smallest(box_.longestMultiplierStep(*x_, *g, *vector(s)));
  };

  EXPECT_EQ(along({0, 0, 0, 0, 0, 0, 0}), test::unbounded);
  EXPECT_EQ(along({-1, 0, 0, 0, 0, 0, 0}), 3);
  EXPECT_EQ(along({-1, -1, 0, 0, 0, 0, 0}), 2);
  EXPECT_EQ(along({-1, -1, 0.5, 0, 0, 12, 0}), 0.5) << "an upper bound's grows to 0";
  EXPECT_EQ(along({1, 1, -1, 0, 0, -1, 0}), test::unbounded) << "all grow away from 0";
  EXPECT_EQ(along({0, 0, 0, 1, 0, 0, 0}), 0) << "a free entry has no multiplier to give";
  EXPECT_EQ(along({0, 0, 0, 0, -100, 0, 0}), test::unbounded) << "that of a fixed entry may have either sign";
}

TEST_F(BoxKernelsTest, MultipliersThatAreNegligibleReleaseNothing) {
  const RCP<Vector> g = vector({-3, -1, 0.5, 0.5, 6, 4, -0.5}), y = vector({9, 9, 9, 9, 9, 9, 9});
  const RCP<Vector> z = vector({-1, -1, 1, 1, 1, 1, 1});

  box_.choppedGradient(*x_, *g, 1, *y);
  EXPECT_EQ(gather(*y), dense({-3, 0, 0, 0, 0, 4, 0}));
  box_.projectedGradient(*x_, *g, 1, *y);
  EXPECT_EQ(gather(*y), dense({-3, 0, 0, 0.5, 0, 4, -0.5})) << "the free gradient stays, however small";
  box_.restrictToReleased(*x_, *g, 1, *z);
  EXPECT_EQ(gather(*z), dense({-1, 0, 0, 1, 0, 1, 1}));
}

TEST_F(BoxKernelsTest, TheRecessionConeHoldsZeroWhereThereWasABound) {
  const RCP<const Map> map = linearMap(7);
  const RCP<const qp::ConvexSet> cone = box_.recessionCone(map);
  const auto projected = [&](double value) {
    Vector d(map);
    d.putScalar(value);
    cone->project(d);
    return gather(d);
  };

  EXPECT_EQ(projected(3), dense({0, 3, 0, 3, 0, 0, 0}));
  EXPECT_EQ(projected(-3), dense({0, 0, -3, -3, 0, 0, 0}));
}

TEST_F(BoxKernelsTest, AShiftedSetIsTheSetSeenFromThere) {
  const RCP<Vector> from = vector({1, -2, 3, 0.5, 0, -1, 2});
  const RCP<const qp::ConvexSet> seen = box_.shiftedBy(*from);
  for (const double value : {-3.0, 0.25, 3.0}) {
    Vector step(from->getMap()), there(*from, Teuchos::Copy);
    step.putScalar(value);
    there.update(1.0, step, 1.0);
    seen->project(step);
    box_.project(there);
    there.update(-1.0, *from, 1.0);
    EXPECT_LE((gather(step) - gather(there)).norm(), 1e-15);
  }
}

TEST_F(BoxKernelsTest, WithoutBoundsEverythingIsFree) {
  const Box none;
  const RCP<Vector> y = vector({0, 0, 0, 0, 0, 0, 0}), d = vector({-1, 1, -2, 2, -3, 3, 0});

  none.freeIndicator(*x_, *y);
  none.recessionCone(linearMap(7))->project(*d);

  EXPECT_EQ(gather(*y), Eigen::VectorXd::Ones(7));
  EXPECT_EQ(gather(*d), dense({-1, 1, -2, 2, -3, 3, 0}));
  EXPECT_EQ(smallest(none.maxFeasibleStep(*x_, *y)), test::unbounded);
}

} // namespace
