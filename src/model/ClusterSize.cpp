#include "epafi/model/ClusterSize.hpp"

#include <algorithm>
#include <cstddef>

namespace epafi::model {

bool clustersPay(int dimension, GlobalOrdinal numSubdomains, int numRanks) {
  const GlobalOrdinal least = dimension == 3 ? 10'000 : 1'000'000;
  return numRanks > 1 && numSubdomains * numRanks >= least;
}

int clusterSizeFor(const mesh::StructuredMesh& mesh, std::array<int, 3> counts, GlobalOrdinal numSubdomains,
                   int numRanks) {
  if (!clustersPay(mesh.dimension(), numSubdomains, numRanks))
    return 0;
  const GlobalOrdinal fewest = mesh.dimension() == 3 ? 27 : 16, most = 64;
  std::array<double, 3> step{}; // from centre to centre
  for (std::size_t d = 0; d < step.size(); ++d)
    step[d] = mesh.elementSize()[d] * mesh.elements()[d] / counts[d];
  const auto size = [&] { return GlobalOrdinal{1} * counts[0] * counts[1] * counts[2]; };
  while (size() > most) {
    std::size_t widest = 0;
    for (std::size_t d = 1; d < step.size(); ++d)
      if ((counts[d] - 1) * step[d] > (counts[widest] - 1) * step[widest] * (1 + 1e-9))
        widest = d;
    if (counts[widest] % 2 != 0)
      return 0;
    counts[widest] /= 2;
  }
  return size() < fewest ? 0 : static_cast<int>(size());
}

} // namespace epafi::model
