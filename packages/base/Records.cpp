#include "epafi/base/Records.hpp"

#include <Tpetra_Distributor.hpp>

#include <algorithm>
#include <numeric>

namespace epafi {

std::vector<char> sendRecordBytes(const RCP<const Comm>& comm, const char* records, std::size_t size,
                                  std::span<const int> ranks) {
  std::vector<std::size_t> order(ranks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
  std::vector<int> targets;
  using Bytes = Kokkos::View<char*, Kokkos::HostSpace>;
  Bytes sent("sent", ranks.size() * size);
  targets.reserve(ranks.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    targets.push_back(ranks[order[k]]);
    std::memcpy(sent.data() + k * size, records + order[k] * size, size);
  }
  Tpetra::Distributor plan(comm);
  Bytes received("received", plan.createFromSends(Teuchos::arrayViewFromVector(targets)) * size);
  plan.doPostsAndWaits(Kokkos::View<const char*, Kokkos::HostSpace>(sent), size, received);
  return {received.data(), received.data() + received.extent(0)};
}

} // namespace epafi
