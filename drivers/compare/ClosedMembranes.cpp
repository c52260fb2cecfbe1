#include "ClosedMembranes.hpp"

#include "UndecomposedSystem.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <cmath>
#include <vector>

namespace epafi::drivers {

LinearSystem closedMembranes(const MembraneChoice& choice) {
  const UndecomposedSystem open =
      undecomposedSystem(scene::modelProblem(choice.coercive, 1, choice.elements));
  const auto size = static_cast<int>(open.load.size());
  std::vector<int> onLine(static_cast<std::size_t>(choice.elements) +
                          1);    // unknowns of the first body, from below
  std::vector<int> number(size); // where both bodies' closed nodes are one
  int count = 0;
  for (int i = 0; i < size; ++i) {
    const std::size_t row = std::lround(open.place(1, i) * choice.elements);
    const bool isOnLine = open.place(0, i) == 1, isFirst = open.body[i] == 0;
    const bool isClosed = isOnLine && row < static_cast<std::size_t>(choice.closedNodes);
    number[i] = isClosed && !isFirst ? onLine[row] : count++;
    if (isOnLine && isFirst)
      onLine[row] = number[i];
  }
  LinearSystem system;
  system.load = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(open.stiffness.nonZeros());
  for (int i = 0; i < size; ++i) {
    const int row = number[i];
    system.load[row] += open.load[i];
    for (UndecomposedSystem::Matrix::InnerIterator entry(open.stiffness, i); entry; ++entry)
      entries.emplace_back(row, number[entry.col()], entry.value());
  }
  system.matrix.resize(count, count);
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

} // namespace epafi::drivers
