#include "epafi/fem/ShapeFunctions.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace epafi::fem {
namespace {

/// Type of a simplex of order 1.
constexpr CellType simplexOf(int dim) {
  return dim == 1 ? CellType::line : dim == 2 ? CellType::triangle : CellType::tetrahedron;
}

/// L_0 … L_dim
template <int dim>
Eigen::Matrix<double, dim + 1, 1> barycentric(const Eigen::Matrix<double, dim, 1>& xi) {
  Eigen::Matrix<double, dim + 1, 1> all;
  all << 1 - xi.sum(), xi;
  return all;
}

/// Their derivatives, a column each.
template <int dim>
Eigen::Matrix<double, dim, dim + 1> barycentricGradients() {
  Eigen::Matrix<double, dim, dim + 1> gradients;
  gradients << Eigen::Matrix<double, dim, 1>::Constant(-1), Eigen::Matrix<double, dim, dim>::Identity();
  return gradients;
}

/// A rule that a simplex's symmetries do not change: the orbits of points with all barycentric coordinates `a` but one, and
/// (tetrahedra) of those with two of each value. Weights are shares of the reference element's measure.
struct Orbit {
  double a, weight;
  bool isPaired = false; ///< a, a, ½ − a, ½ − a
};

template <int dim>
std::vector<RulePoint<dim>> ruleOf(std::initializer_list<Orbit> orbits) {
  std::vector<RulePoint<dim>> rule;
  const auto add = [&](const Eigen::Matrix<double, dim + 1, 1>& all, double weight) {
    rule.push_back({all.template tail<dim>(), weight * Simplex<dim>::measure});
  };
  for (const Orbit& orbit : orbits)
    for (int i = 0; i <= dim; ++i) {
      Eigen::Matrix<double, dim + 1, 1> all;
      if (!orbit.isPaired) {
        all.setConstant(orbit.a);
        all[i] = 1 - dim * orbit.a;
        add(all, orbit.weight);
      }
      for (int j = 0; j < i && orbit.isPaired; ++j) {
        all.setConstant(0.5 - orbit.a);
        all[i] = all[j] = orbit.a;
        add(all, orbit.weight);
      }
    }
  return rule;
}

/// Degree 2 on triangles, 3 on tetrahedra (Walkington 2000); of an edge three Gauss points, degree 5.
template <int dim>
std::vector<RulePoint<dim>> lowDegree() {
  if constexpr (dim == 1) {
    const double away = 0.5 * std::sqrt(0.6);
    using Point = Eigen::Matrix<double, 1, 1>;
    return {{Point(0.5 - away), 5.0 / 18}, {Point(0.5), 8.0 / 18}, {Point(0.5 + away), 5.0 / 18}};
  } else if constexpr (dim == 2) {
    return ruleOf<2>({{1.0 / 6, 1.0 / 3}});
  } else {
    return ruleOf<3>({{0.32805469671142664734, 6 * 0.02308799441864369039},
                      {0.10695227393293068277, 6 * 0.01857867224802297628}});
  }
}

/// Degree 4 on triangles (Strang, Fix 1973), 5 on tetrahedra (Walkington 2000); all weights are positive.
template <int dim>
std::vector<RulePoint<dim>> highDegree() {
  if constexpr (dim == 1)
    return lowDegree<1>();
  else if constexpr (dim == 2)
    return ruleOf<2>(
        {{0.44594849091596489, 0.22338158967801147}, {0.091576213509770743, 0.10995174365532187}});
  else
    return ruleOf<3>({{0.31088591926330060980, 0.11268792571801585080},
                      {0.092735250310891226402, 0.073493043116361949544},
                      {0.045503704125649649492, 0.042546020777081466438, true}});
}

/// The order's function that is 1 at −1, 0 or 1 (`place` = −1, 0, 1) and 0 at the other nodes, and its derivative.
template <int order>
double along(int place, double x) {
  if constexpr (order == 1)
    return 0.5 * (1 + place * x);
  return place == 0 ? (1 - x) * (1 + x) : 0.5 * x * (x + place);
}
template <int order>
double slope(int place, double x) {
  if constexpr (order == 1)
    return 0.5 * place;
  return place == 0 ? -2 * x : x + 0.5 * place;
}

/// Middle of the nodes between which a node of order 2 lies: of an edge, a face, or the whole brick.
template <int dim>
Eigen::Matrix<double, dim, 1> brickMiddle(int number) {
  constexpr int corners = 1 << dim, edges = dim == 2 ? 4 : 12;
  using Coordinates = typename Brick<dim>::Coordinates;
  const auto ends = edgesOf(dim == 2 ? CellType::quadrilateral : CellType::hexahedron);
  if (const int edge = number - corners; edge < edges) {
    const std::size_t first = 2 * static_cast<std::size_t>(edge);
    return 0.5 * (Brick<dim>::node(ends[first]) + Brick<dim>::node(ends[first + 1]));
  }
  Coordinates middle = Coordinates::Zero();
  if (const int face = number - corners - edges; dim == 3 && face < 6)
    middle[face / 2] = face % 2 == 0 ? -1 : 1;
  return middle;
}

} // namespace

template <int dim, int order>
typename Simplex<dim, order>::Values Simplex<dim, order>::values(const Coordinates& xi) {
  if constexpr (order == 1) {
    return barycentric<dim>(xi);
  } else {
    const auto all = barycentric<dim>(xi);
    Values values;
    values.template head<dim + 1>() = (all.array() * (2 * all.array() - 1)).matrix();
    const auto ends = edgesOf(simplexOf(dim));
    for (std::size_t e = 0; 2 * e < ends.size(); ++e)
      values[dim + 1 + static_cast<int>(e)] = 4 * all[ends[2 * e]] * all[ends[2 * e + 1]];
    return values;
  }
}

template <int dim, int order>
typename Simplex<dim, order>::Gradients
Simplex<dim, order>::gradients([[maybe_unused]] const Coordinates& xi) {
  if constexpr (order == 1) {
    return barycentricGradients<dim>();
  } else {
    const auto ofAll = barycentricGradients<dim>();
    const auto all = barycentric<dim>(xi);
    Gradients gradients;
    for (int a = 0; a <= dim; ++a)
      gradients.col(a) = (4 * all[a] - 1) * ofAll.col(a);
    const auto ends = edgesOf(simplexOf(dim));
    for (std::size_t e = 0; 2 * e < ends.size(); ++e) {
      const int a = ends[2 * e], b = ends[2 * e + 1];
      gradients.col(dim + 1 + static_cast<int>(e)) = 4 * (all[a] * ofAll.col(b) + all[b] * ofAll.col(a));
    }
    return gradients;
  }
}

template <int dim, int order>
typename Simplex<dim, order>::Coordinates Simplex<dim, order>::node(int number) {
  if (number > dim) {
    const auto ends = edgesOf(simplexOf(dim));
    const std::size_t first = 2 * static_cast<std::size_t>(number - dim - 1);
    return 0.5 * (node(ends[first]) + node(ends[first + 1]));
  }
  return number == 0 ? Coordinates(Coordinates::Zero()) : Coordinates(Coordinates::Unit(number - 1));
}

template <int dim, int order>
typename Simplex<dim, order>::Coordinates Simplex<dim, order>::centre() {
  return Coordinates::Constant(1.0 / (dim + 1));
}

template <int dim, int order>
typename Simplex<dim, order>::Rule Simplex<dim, order>::gaussPoints() {
  static const auto rule =
      order == 1 ? std::vector<RulePoint<dim>>{{centre(), Simplex::measure}} : lowDegree<dim>();
  return rule;
}

template <int dim, int order>
typename Simplex<dim, order>::Rule Simplex<dim, order>::finePoints() {
  static const auto rule =
      order == 1 ? std::vector<RulePoint<dim>>{{centre(), Simplex::measure}} : highDegree<dim>();
  return rule;
}

template <int dim, int order>
typename Brick<dim, order>::Values Brick<dim, order>::values(const Coordinates& xi) {
  Values values;
  for (int a = 0; a < Types::numNodes; ++a) {
    const Coordinates at = node(a);
    double product = 1;
    for (int i = 0; i < dim; ++i)
      product *= along<order>(static_cast<int>(at[i]), xi[i]);
    values[a] = product;
  }
  return values;
}

template <int dim, int order>
typename Brick<dim, order>::Gradients Brick<dim, order>::gradients(const Coordinates& xi) {
  Gradients gradients;
  for (int a = 0; a < Types::numNodes; ++a) {
    const Coordinates at = node(a);
    for (int i = 0; i < dim; ++i) {
      double product = 1;
      for (int k = 0; k < dim; ++k)
        product *= k == i ? slope<order>(static_cast<int>(at[k]), xi[k])
                          : along<order>(static_cast<int>(at[k]), xi[k]);
      gradients(i, a) = product;
    }
  }
  return gradients;
}

template <int dim, int order>
typename Brick<dim, order>::Coordinates Brick<dim, order>::node(int number) {
  if (number >= (1 << dim))
    return brickMiddle<dim>(number);
  const int around = number % 4; // counter-clockwise in the plane, then the same above
  Coordinates corner;
  corner[0] = around == 1 || around == 2 ? 1 : -1;
  corner[1] = around >= 2 ? 1 : -1;
  if constexpr (dim == 3)
    corner[2] = number >= 4 ? 1 : -1;
  return corner;
}

template <int dim, int order>
typename Brick<dim, order>::Rule Brick<dim, order>::gaussPoints() {
  static const auto rule = [] {
    const double away = order == 1 ? 1 / std::sqrt(3.0) : std::sqrt(0.6);
    std::vector<RulePoint<dim>> points;
    for (int a = 0; a < Types::numNodes; ++a) {
      const Coordinates at = node(a);
      double weight = 1;
      for (int i = 0; i < dim && order == 2; ++i)
        weight *= at[i] == 0 ? 8.0 / 9 : 5.0 / 9;
      points.push_back({away * at, weight});
    }
    return points;
  }();
  return rule;
}

template struct Simplex<1>;
template struct Simplex<2>;
template struct Simplex<3>;
template struct Brick<2>;
template struct Brick<3>;
template struct Simplex<1, 2>;
template struct Simplex<2, 2>;
template struct Simplex<3, 2>;
template struct Brick<2, 2>;
template struct Brick<3, 2>;

} // namespace epafi::fem
