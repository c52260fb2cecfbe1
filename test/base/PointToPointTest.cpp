#include "epafi/base/PointToPoint.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace {

using namespace epafi;

/// What rank `from` sends to rank `to`: as many numbers as the ranks differ by, less one, so that neighbours
/// send nothing.
std::vector<double> message(int from, int to) {
  std::vector<double> values;
  for (int i = 1; i < std::abs(from - to); ++i)
    values.push_back(100.0 * from + 10.0 * to + i);
  return values;
}

TEST(PointToPointTest, EveryRankGetsWhatEveryOtherSendsEmptyMessagesToo) {
  const auto comm = Tpetra::getDefaultComm();
  const int here = comm->getRank();
  std::map<int, std::vector<double>> outgoing;
  std::set<int> senders;
  for (int rank = 0; rank < comm->getSize(); ++rank)
    if (rank != here) {
      outgoing[rank] = message(here, rank);
      senders.insert(rank);
    }

  const auto received = exchange(*comm, outgoing, senders);

  ASSERT_EQ(received.size(), senders.size());
  for (const auto& [rank, values] : received)
    EXPECT_EQ(values, message(rank, here)) << rank;
}

TEST(PointToPointTest, RanksMayHaveNothingToSayToEachOther) {
  const auto comm = Tpetra::getDefaultComm();
  const int here = comm->getRank(), last = comm->getSize() - 1;
  std::map<int, std::vector<double>> outgoing;
  std::set<int> senders;
  if (here == last && last > 0)
    outgoing[0] = {1.5, -2.5};
  if (here == 0 && last > 0)
    senders = {last};

  const auto received = exchange(*comm, outgoing, senders);

  if (here == 0 && last > 0)
    EXPECT_EQ(received.at(last), (std::vector<double>{1.5, -2.5}));
  else
    EXPECT_TRUE(received.empty());
}

TEST(PointToPointTest, ReceiversNeedNotKnowWhoSends) {
  const auto comm = Tpetra::getDefaultComm();
  const int here = comm->getRank(), size = comm->getSize();
  std::map<int, std::vector<int>> outgoing; // to itself and every other rank below
  for (int rank = here; rank >= 0; rank -= 2)
    outgoing[rank] = std::vector<int>(static_cast<std::size_t>(here), rank);

  const auto received = deliver(*comm, outgoing);

  std::size_t number = 0;
  for (int rank = here; rank < size; rank += 2, ++number)
    EXPECT_EQ(received.at(rank), std::vector<int>(static_cast<std::size_t>(rank), here)) << rank;
  EXPECT_EQ(received.size(), number);
}

TEST(PointToPointTest, LongMessagesGoInPieces) {
  const auto comm = Tpetra::getDefaultComm();
  const int here = comm->getRank(), size = comm->getSize(), next = (here + 1) % size,
            last = (here + size - 1) % size;
  constexpr std::size_t longest = 16;
  for (const std::size_t bytes : {0U, 7U, 16U, 17U, 32U, 50U}) { // some of them whole pieces
    const std::vector<std::byte> sent(bytes, static_cast<std::byte>(here + 1));
    std::vector<std::byte> received;
    const detail::Message message{next, sent};
    detail::exchange(
        *comm, std::span(&message, 1), {last},
        [&](int, std::size_t from, std::size_t more) {
          EXPECT_EQ(from, received.size());
          received.resize(from + more);
          return received.data() + from;
        },
        longest);
    EXPECT_EQ(received, std::vector<std::byte>(bytes, static_cast<std::byte>(last + 1)));
  }
}

TEST(PointToPointTest, IndicesTravelAsWhatTheyAreAndMessagesInTheirOrder) {
  const auto comm = Tpetra::getDefaultComm();
  const int here = comm->getRank(), size = comm->getSize(), next = (here + 1) % size,
            last = (here + size - 1) % size;
  const GlobalOrdinal large = (GlobalOrdinal{1} << 53) + 1; // no double
  for (GlobalOrdinal message = 0; message < 3; ++message) {
    const std::map<int, std::vector<GlobalOrdinal>> outgoing{{next, {large + message, here}}};
    const auto received = exchange(*comm, outgoing, {last});
    EXPECT_EQ(received.at(last), (std::vector<GlobalOrdinal>{large + message, last}));
  }
}

} // namespace
