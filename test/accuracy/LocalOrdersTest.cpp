// The order at which errors fall, as two meshes tell.

#include "epafi/accuracy/LocalOrders.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace epafi::accuracy {
namespace {

/// η² = h^(2q) |K| with h^d = |K|.
double squaredError(double measure, double order, int dimension) {
  return std::pow(measure, 2 * order / dimension) * measure;
}

/// One element of measure 1 with an order that was taken to be `before`, and its `number` equal parts of
/// these measures.
double orderAfter(double order, double before, int dimension, std::size_t number, double measure,
                  int orderOfElements = 2) {
  const ElementErrors last{{squaredError(1, order, dimension)}, {1.0}, {before}};
  const std::vector<double> result =
      localOrders(last, std::vector<LocalOrdinal>(number, 0),
                  std::vector<double>(number, squaredError(measure, order, dimension)),
                  std::vector<double>(number, measure), dimension, orderOfElements);
  EXPECT_EQ(result, std::vector<double>(number, result.front()));
  return result.front();
}

/// As far from the old order to that which is seen as halvings / (halvings + 1) says.
TEST(LocalOrdersTest, TheMoreHalvingsTheMoreTheOrderIsWhatIsSeen) {
  for (const int dimension : {2, 3})
    for (const double order : {0.5, 1.0, 1.7}) {
      double distance = 2 - order;
      for (const int halvings : {1, 2, 3}) {
        const auto number = std::size_t{1} << static_cast<unsigned>(dimension * halvings);
        const double result = orderAfter(order, 2, dimension, number, 1 / static_cast<double>(number));
        EXPECT_NEAR(result, order + (2 - order) / (halvings + 1), 1e-12);
        EXPECT_LT(std::abs(result - order), distance);
        distance = std::abs(result - order);
      }
      // A small element that lies in a large one, as a mesh that is made anew has them.
      EXPECT_NEAR(orderAfter(order, 2, dimension, 1, std::exp2(-99 * dimension)), order, 0.02);
      EXPECT_NEAR(orderAfter(order, order, dimension, 1, 0.1), order, 1e-12);
    }
}

TEST(LocalOrdersTest, WhereElementsAreAboutAsLargeTheOrderStaysAsItWas) {
  for (const int dimension : {2, 3}) {
    EXPECT_EQ(orderAfter(0.5, 1.3, dimension, 1, 1), 1.3);
    EXPECT_EQ(orderAfter(0.5, 1.3, dimension, 1, 0.8), 1.3);
    EXPECT_EQ(orderAfter(0.5, 1.3, dimension, 1, 9), 1.3); // coarser
  }
}

TEST(LocalOrdersTest, EachElementHasItsOwnOrderWithAllPartsOfItTogether) {
  // Four elements of measure 1: two cut in four, with q = 1 and q = 0.5; one not cut; one with a zero where
  // none was.
  const ElementErrors last{{1, 1, 1, 0}, {1, 1, 1, 1}, {2, 2, 1.5, 1.5}};
  const std::vector<LocalOrdinal> ancestors{1, 0, 2, 1, 0, 3, 0, 1, 1, 0, 3, 3, 3};
  std::vector<double> squared, measures;
  for (const LocalOrdinal ancestor : ancestors) {
    measures.push_back(ancestor == 2 ? 1 : 0.25);
    squared.push_back(ancestor == 2 ? 1 : ancestor == 3 ? 0 : squaredError(0.25, ancestor == 0 ? 1 : 0.5, 2));
  }
  squared[1] *= 1.5; // what one part has more another has less
  squared[4] *= 0.5;
  const std::vector<double> orders = localOrders(last, ancestors, squared, measures, 2, 2);
  const std::vector<double> expected{1.5, 1.25, 1.5, 1.5};
  for (std::size_t e = 0; e < ancestors.size(); ++e)
    EXPECT_NEAR(orders[e], expected[ancestors[e]], 1e-12);
}

/// Halved once, from 1 to (1 + seen)/2.
TEST(LocalOrdersTest, IsNeverAboveTheOrderOfTheElementsNorBelowTheLeast) {
  const auto seen = [](double squaredErrorOfParts, int order) {
    const ElementErrors last{{1}, {1}, {1}};
    return 2 * localOrders(last, std::vector<LocalOrdinal>(4, 0),
                           std::vector<double>(4, squaredErrorOfParts / 4), std::vector<double>(4, 0.25), 2,
                           order)
                   .front() -
           1;
  };
  for (const int order : {1, 2})
    EXPECT_NEAR(seen(1e-9, order), order, 1e-12);
  EXPECT_NEAR(seen(1, 2), 0.4, 1e-12);  // no less error
  EXPECT_NEAR(seen(50, 2), 0.4, 1e-12); // more of it
}

TEST(LocalOrdersTest, DoesNotDependOnTheUnitsOfErrorsAndLengths) {
  const ElementErrors last{{3}, {2}, {2}}, scaled{{3e8}, {2e-6}, {2}};
  const std::vector<LocalOrdinal> ancestors{0, 0};
  const std::vector<double> one = localOrders(last, ancestors, std::vector<double>{0.3, 0.4},
                                              std::vector<double>{0.5, 1.5}, 2, 2),
                            other = localOrders(scaled, ancestors, std::vector<double>{0.3e8, 0.4e8},
                                                std::vector<double>{0.5e-6, 1.5e-6}, 2, 2);
  EXPECT_NEAR(one[0], other[0], 1e-12);
  EXPECT_NEAR(one[1], other[1], 1e-12);
}

} // namespace
} // namespace epafi::accuracy
