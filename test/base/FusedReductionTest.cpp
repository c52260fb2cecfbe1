#include "epafi/base/AccurateSum.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace epafi;

TEST(FusedReductionTest, AddsTheSumsAndTakesTheMinimum) {
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), size = comm->getSize();
  FusedReduction reduction(comm, 3);

  for (int repeat = 0; repeat < 3; ++repeat) {
    reduction.clear();
    reduction.sums()[0].add(1);
    reduction.sums()[1].add(rank);
    reduction.sums()[2].add(-2.0 * rank);
    reduction.setMinimum(10.0 - rank);

    reduction.reduce();

    EXPECT_EQ(reduction.sum(0), size);
    EXPECT_EQ(reduction.sum(1), size * (size - 1) / 2);
    EXPECT_EQ(reduction.sum(2), -size * (size - 1));
    EXPECT_EQ(reduction.minimum(), 10.0 - (size - 1));
  }
}

TEST(FusedReductionTest, StartsAtZeroAndInfinity) {
  FusedReduction reduction(Tpetra::getDefaultComm(), 1);

  reduction.reduce();

  EXPECT_EQ(reduction.sum(0), 0);
  EXPECT_EQ(reduction.minimum(), std::numeric_limits<double>::infinity());
}

} // namespace
