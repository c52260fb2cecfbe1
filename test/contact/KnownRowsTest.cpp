// Rows that two contacts of a scene would both bring.

#include "support/Refusal.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/KnownRows.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace epafi;
using contact::ContactLayout;
using contact::KnownRows;

constexpr double spacing = 0.5; // of nodes

/// A contact of nodes 0, 1, … of body 0 with an obstacle, in the plane, in one direction.
ContactLayout onObstacle(const std::string& name, const std::vector<GlobalOrdinal>& nodes, double upwards,
                         double gap) {
  ContactLayout contact;
  contact.name = name;
  contact.firstNodes = nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    contact.directions.insert(contact.directions.end(), {0.0, upwards});
  contact.gaps.assign(nodes.size(), gap);
  contact.areas.assign(nodes.size(), 0.5);
  return contact;
}

TEST(KnownRowsTest, OnlyWhatIsNewStays) {
  KnownRows known;
  ContactLayout floor = onObstacle("floor", {0, 1, 2}, -1, 0.25),
                again = onObstacle("again", {1, 2, 3}, -1, 0.25);
  known.dropFrom(floor, spacing);
  known.dropFrom(again, spacing);
  EXPECT_EQ(floor.numRows(), 3);
  EXPECT_EQ(again.firstNodes, std::vector<GlobalOrdinal>{3});
  EXPECT_EQ(again.directions.size(), 2U);
  EXPECT_EQ(again.gaps.size(), 1U);
  EXPECT_EQ(again.areas.size(), 1U);
}

TEST(KnownRowsTest, AnotherGapIsNew) {
  KnownRows known;
  ContactLayout floor = onObstacle("floor", {0, 1}, -1, 0.25), lower = onObstacle("lower", {0, 1}, -1, 0.5);
  known.dropFrom(floor, spacing);
  known.dropFrom(lower, spacing);
  EXPECT_EQ(lower.numRows(), 2);
}

TEST(KnownRowsTest, ANodeBetweenOppositeContactsNeedsRoom) {
  ContactLayout floor = onObstacle("floor", {0, 1, 2}, -1, 0), high = onObstacle("high", {0}, 1, 0.125);
  KnownRows roomy;
  roomy.dropFrom(floor, spacing);
  roomy.dropFrom(high, spacing);
  EXPECT_EQ(high.numRows(), 1);

  ContactLayout ceiling = onObstacle("ceiling", {1}, 1, -0.125);
  test::expectSays(
      test::unsolvable(SolvabilityError::Kind::noSolution, [&] { roomy.dropFrom(ceiling, spacing); }),
      {"'floor'", "'ceiling'", "overlap by 0.125"});
}

} // namespace
