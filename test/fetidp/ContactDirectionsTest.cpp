#include "epafi/fetidp/equilibrium/ContactDirections.hpp"

#include "support/DenseProblem.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace epafi::fetidp {
namespace {

TEST(ContactDirectionsTest, KeepsEachDirectionOnceWithItsLeastNumber) {
  DistinctDirections directions(2);
  directions.add(Eigen::Vector2d(2, 0), 6);      // 3 for length 1
  directions.add(Eigen::Vector2d(5, 1e-14), 10); // the same one, 2
  directions.add(Eigen::Vector2d(0, 0), -1);     // none
  directions.add(Eigen::Vector2d(-1, 0), 1);     // the opposite one
  directions.add(Eigen::Vector2d(1, 1e-6), 7);   // another one
  EXPECT_LE((directions.values() - Eigen::Vector3d(1, 2, 7)).norm(), 1e-10);
  Eigen::MatrixXd expected(2, 3);
  expected << -1, 1, 1, 0, 0, 1e-6;
  EXPECT_LE((directions.matrix() - expected).norm(), 1e-12);
}

TEST(ContactDirectionsTest, AllRanksHaveThoseOfAll) {
  DistinctDirections directions(2);
  const int rank = world()->getRank();
  directions.add(Eigen::Vector2d(1, 0), 10.0 - rank);
  directions.add(Eigen::Vector2d(std::cos(1.0 + rank), std::sin(1.0 + rank)), rank);
  directions.gather(*world());
  const Eigen::VectorXd values = directions.values();
  ASSERT_EQ(values.size(), 1 + world()->getSize());
  EXPECT_EQ(values[values.size() - 1], 11.0 - world()->getSize()); // the others point away from x
}

TEST(ContactDirectionsTest, ThousandsAreToldApartQuickly) {
  DistinctDirections directions(18);
  for (int repeat = 0; repeat < 2; ++repeat)
    for (int j = 0; j < 20000; ++j) { // 4·10⁸ comparisons if each were compared with each
      const int round = j / 18;
      directions.add(
          Eigen::VectorXd::Unit(18, j % 18) + 1e-5 * round * Eigen::VectorXd::Unit(18, (j + 1) % 18), repeat);
    }
  EXPECT_EQ(directions.values(), Eigen::VectorXd::Zero(20000));
}

} // namespace
} // namespace epafi::fetidp
