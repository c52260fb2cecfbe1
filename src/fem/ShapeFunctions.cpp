#include "epafi/fem/ShapeFunctions.hpp"

#include <cmath>

namespace epafi::fem {

template <int dim>
typename Simplex<dim>::Values Simplex<dim>::values(const Coordinates& xi) {
  Values values;
  values << 1 - xi.sum(), xi;
  return values;
}

template <int dim>
typename Simplex<dim>::Gradients Simplex<dim>::gradients(const Coordinates& /*xi*/) {
  Gradients gradients;
  gradients << Coordinates::Constant(-1), Eigen::Matrix<double, dim, dim>::Identity();
  return gradients;
}

template <int dim>
typename Simplex<dim>::Coordinates Simplex<dim>::corner(int node) {
  return node == 0 ? Coordinates(Coordinates::Zero()) : Coordinates(Coordinates::Unit(node - 1));
}

template <int dim>
typename Simplex<dim>::Coordinates Simplex<dim>::centre() {
  return Coordinates::Constant(1.0 / (dim + 1));
}

template <int dim>
typename Brick<dim>::Values Brick<dim>::values(const Coordinates& xi) {
  Values values;
  for (int a = 0; a < (1 << dim); ++a)
    values[a] = (0.5 * (1 + corner(a).array() * xi.array())).prod();
  return values;
}

template <int dim>
typename Brick<dim>::Gradients Brick<dim>::gradients(const Coordinates& xi) {
  Gradients gradients;
  for (int a = 0; a < (1 << dim); ++a) {
    const Coordinates sign = corner(a);
    for (int i = 0; i < dim; ++i) {
      Coordinates factors = 0.5 * (1 + sign.array() * xi.array());
      factors[i] = 0.5 * sign[i];
      gradients(i, a) = factors.prod();
    }
  }
  return gradients;
}

template <int dim>
typename Brick<dim>::Coordinates Brick<dim>::corner(int node) {
  const int around = node % 4; // counter-clockwise in the plane, then the same above
  Coordinates corner;
  corner[0] = around == 1 || around == 2 ? 1 : -1;
  corner[1] = around >= 2 ? 1 : -1;
  if constexpr (dim == 3)
    corner[2] = node >= 4 ? 1 : -1;
  return corner;
}

template <int dim>
typename Brick<dim>::Coordinates Brick<dim>::gaussPoint(int point) {
  return corner(point) / std::sqrt(3.0);
}

template struct Simplex<1>;
template struct Simplex<2>;
template struct Simplex<3>;
template struct Brick<2>;
template struct Brick<3>;

} // namespace epafi::fem
