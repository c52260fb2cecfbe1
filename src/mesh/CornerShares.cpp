#include "epafi/mesh/ShapeFunctions.hpp"

#include <array>
#include <cstddef>

namespace epafi::mesh {

const Eigen::MatrixXd& cornerShares(CellType type) {
  static const auto shares = [] {
    constexpr double roundOff = 1e-12;
    std::array<Eigen::MatrixXd, static_cast<std::size_t>(CellType::hexahedron20) + 1> all;
    for (std::size_t number = 0; number < all.size(); ++number)
      if (const auto known = static_cast<CellType>(number); dimensionOf(known) > 1)
        withShape(known, [&]<int dim>(const Shape<dim>& shape) {
          all[number].resize(shape.numNodes, numCornersOf(known));
          for (int a = 0; a < shape.numNodes; ++a)
            all[number].row(a) = referenceShape<dim>(withOrder(known, 1)).values(shape.node(a));
          all[number] = (all[number].array().abs() < roundOff).select(0, all[number]).eval();
        });
    return all;
  }();
  return shares[static_cast<std::size_t>(type)];
}

} // namespace epafi::mesh
