#include "epafi/base/Maps.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace {

using namespace epafi;

std::vector<GlobalOrdinal> indicesOf(const Map& map) {
  const auto indices = localIndices(map);
  return {indices.begin(), indices.end()};
}

TEST(MapsTest, HasSortedIndicesOnceAndMayBeEmptyOnARank) {
  const auto comm = Tpetra::getDefaultComm();
  const GlobalOrdinal here = comm->getRank();
  std::vector<GlobalOrdinal> indices{10 * here + 4, 10 * here + 1, 10 * here + 4},
      expected{10 * here + 1, 10 * here + 4};
  if (here == 1)
    indices = expected = {};
  const RCP<const Map> map = makeMap(indices, comm);
  EXPECT_EQ(indicesOf(*map), expected);
  EXPECT_EQ(map->getGlobalNumElements(),
            2u * static_cast<std::size_t>(comm->getSize() > 1 ? comm->getSize() - 1 : 1));
}

TEST(MapsTest, KeepsAnOrder) {
  const auto comm = Tpetra::getDefaultComm();
  const GlobalOrdinal here = comm->getRank();
  const std::vector<GlobalOrdinal> indices{10 * here + 4, 10 * here + 1};
  EXPECT_EQ(indicesOf(*mapInOrder(indices, comm)), indices);
}

} // namespace
