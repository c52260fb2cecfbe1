#include "epafi/base/AccurateSum.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace epafi;

TEST(AccurateSumTest, KeepsWhatDoublesLose) {
  AccurateSum sum;
  for (const double term : {1.0, 1e100, 1.0, -1e100})
    sum.add(term);

  EXPECT_EQ(sum.value(), 2.0);
}

/// Terms of either sign over twelve orders of magnitude.
std::vector<double> terms(int count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> result;
  for (int i = 0; i < count; ++i)
    result.push_back(normal(random) * std::pow(10.0, i % 13 - 6));
  return result;
}

TEST(AccurateSumTest, DoesNotDependOnTheOrder) {
  std::vector<double> values = terms(10000);
  std::mt19937 random(2);
  AccurateSum first;
  for (const double value : values)
    first.add(value);

  for (int repeat = 0; repeat < 20; ++repeat) {
    std::shuffle(values.begin(), values.end(), random);
    AccurateSum sum;
    for (const double value : values)
      sum.add(value);
    EXPECT_EQ(sum.value(), first.value());
  }
}

TEST(AccurateSumTest, PropagatesWhatIsNotFinite) {
  AccurateSum sum;
  sum.add(std::nan(""));
  sum.add(1.0);

  EXPECT_TRUE(std::isnan(sum.value()));
}

TEST(AccurateSumTest, OverRanksIsTheSumOfOneRank) {
  const auto comm = Tpetra::getDefaultComm();
  const std::vector<double> values = terms(1000);
  AccurateSum alone;
  for (const double value : values)
    alone.add(value);
  std::vector<AccurateSum> sums(3);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (static_cast<int>(i) % comm->getSize() == comm->getRank())
      sums[1].add(values[i]);
  sums[2].add(1.0);

  sumOverRanks(*comm, sums);

  EXPECT_EQ(sums[0].value(), 0.0);
  EXPECT_EQ(sums[1].value(), alone.value());
  EXPECT_EQ(sums[2].value(), comm->getSize());
}

TEST(AccurateSumTest, DotProductsAreTheSameHoweverTheVectorIsDistributed) {
  const auto comm = Tpetra::getDefaultComm();
  const std::vector<double> values = terms(500);
  const auto dotOn = [&](const RCP<const Map>& map) {
    Vector x(map), y(map);
    for (std::size_t i = 0; i < numLocal(*map); ++i) {
      const auto global = map->getGlobalElement(static_cast<LocalOrdinal>(i));
      x.replaceLocalValue(static_cast<LocalOrdinal>(i), values[global]);
      y.replaceLocalValue(static_cast<LocalOrdinal>(i), 1.0 / (1.0 + static_cast<double>(global)));
    }
    return accurateDot(x, y);
  };
  const RCP<const Map> even = rcp(new Map(values.size(), 0, comm));
  const RCP<const Map> onFirst =
      rcp(new Map(values.size(), comm->getRank() == 0 ? values.size() : 0, 0, comm));

  EXPECT_EQ(dotOn(even), dotOn(onFirst));
}

} // namespace
