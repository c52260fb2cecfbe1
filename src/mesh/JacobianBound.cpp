#include "epafi/mesh/JacobianBound.hpp"

#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace epafi::mesh {
namespace {

/// A part of a reference element: origin + axes · ξ for all ξ of the whole.
template <int dim>
struct Part {
  Coordinates<dim> origin = Coordinates<dim>::Zero();
  Eigen::Matrix<double, dim, dim> axes = Eigen::Matrix<double, dim, dim>::Identity();

  /// Both halves: of a brick across its longest axis, of a simplex across its longest edge.
  [[nodiscard]] std::array<Part, 2> halves(bool isSimplex) const {
    std::array<Part, 2> both{*this, *this};
    if (!isSimplex) {
      Eigen::Index axis = 0;
      axes.colwise().squaredNorm().maxCoeff(&axis);
      for (int side = 0; side < 2; ++side) {
        both[side].axes.col(axis) *= 0.5;
        both[side].origin += (side - 0.5) * axes.col(axis);
      }
    } else {
      const auto [a, b] = longestEdge();
      const Coordinates<dim> middle = 0.5 * (corner(a) + corner(b));
      both[0].moveCorner(a, middle);
      both[1].moveCorner(b, middle);
    }
    return both;
  }

private:
  [[nodiscard]] Coordinates<dim> corner(int number) const {
    return number == 0 ? origin : Coordinates<dim>(origin + axes.col(number - 1));
  }
  void moveCorner(int number, const Coordinates<dim>& to) {
    if (number == 0) {
      axes.colwise() += origin - to;
      origin = to;
    } else {
      axes.col(number - 1) = to - origin;
    }
  }
  [[nodiscard]] std::pair<int, int> longestEdge() const {
    std::pair<int, int> edge{0, 1};
    for (int a = 0; a <= dim; ++a)
      for (int b = 0; b < a; ++b)
        if ((corner(a) - corner(b)).norm() > (corner(edge.first) - corner(edge.second)).norm())
          edge = {a, b};
    return edge;
  }
};

double factorial(int n) {
  return n < 2 ? 1 : n * factorial(n - 1);
}

/// Bernstein's basis of the polynomials that determinants are.
template <int dim>
class Bernstein {
public:
  explicit Bernstein(const Shape<dim>& shape)
      : isSimplex_(shape.isSimplex),
        degree_(shape.isSimplex ? dim * (shape.order - 1) : dim * shape.order - 1) {
    std::vector<Exponents> all;
    for (int code = 0; code < power(degree_ + 1, dim); ++code) {
      Exponents exponents{};
      exponents.back() = degree_;
      for (int i = 0, left = code, base = degree_ + 1; i < dim; ++i, left /= base)
        exponents.back() -= exponents[i] = left % base;
      if (isSimplex_ && exponents.back() < 0)
        continue;
      all.push_back(exponents);
      Coordinates<dim> point;
      for (std::size_t i = 0; i < dim; ++i)
        point[i] = static_cast<double>(exponents[i]) / degree_;
      points_.push_back(isSimplex_ ? point : Coordinates<dim>(2 * point - Coordinates<dim>::Ones()));
    }
    Eigen::MatrixXd values(all.size(), all.size());
    for (std::size_t row = 0; row < all.size(); ++row)
      for (std::size_t column = 0; column < all.size(); ++column)
        values(row, column) = at(points_[row], all[column]);
    toCoefficients_ = direct::leastSquares(values, Eigen::MatrixXd::Identity(values.rows(), values.cols()));
  }

  /// Least value at the points of a part, and least coefficient there.
  template <class Polynomial>
  std::pair<double, double> least(const Part<dim>& part, const Polynomial& polynomial) const {
    Eigen::VectorXd values(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i)
      values[i] = polynomial(part.origin + part.axes * points_[i]);
    return {values.minCoeff(), (toCoefficients_ * values).minCoeff()};
  }

private:
  /// The last one: what is left of the degree, on simplices.
  using Exponents = std::array<int, dim + 1>;

  [[nodiscard]] double at(const Coordinates<dim>& xi, const Exponents& exponents) const {
    double value = 1;
    for (int i = 0; i < dim; ++i) {
      const int k = exponents[i];
      const double x = isSimplex_ ? xi[i] : 0.5 * (1 + xi[i]);
      value *= std::pow(x, k) / factorial(k);
      if (!isSimplex_)
        value *= factorial(degree_) * std::pow(1 - x, degree_ - k) / factorial(degree_ - k);
    }
    return isSimplex_ ? value * factorial(degree_) * std::pow(1 - xi.sum(), exponents.back()) /
                            factorial(exponents.back())
                      : value;
  }

  bool isSimplex_;
  int degree_; ///< altogether on simplices, in each coordinate on bricks: of a product of `dim` derivatives
  std::vector<Coordinates<dim>> points_;
  Eigen::MatrixXd toCoefficients_;
};

/// The point of a reference element that a point of the brick [−1, 1]^dim is carried to, of a simplex or
/// brick itself: prisms and pyramids are bricks that have shrunk to an edge or a point, and their
/// determinants polynomials of the brick's degrees there. A pyramid's top depends on where one comes from,
/// and is left out.
template <int dim>
Coordinates<dim> carried(const Shape<dim>& shape, const Coordinates<dim>& at) {
  if constexpr (dim == 3)
    if (!shape.isSimplex && !shape.isBrick) {
      constexpr double nextToTop = 0x1p-20; // of which 1 − (1 − r) is exact
      const Coordinates<3> part = 0.5 * (at + Coordinates<3>::Ones());
      if (numCornersOf(shape.type) == 6)
        return {part[0] * (1 - part[1]), part[1], at[2]};
      const double r = std::max(1 - part[2], nextToTop);
      return {r * at[0], r * at[1], 1 - r};
    }
  return at;
}

/// Made once. Precondition: order 2.
template <int dim>
const Bernstein<dim>& basisOf(const Shape<dim>& shape) {
  constexpr bool isPlane = dim == 2;
  static const Bernstein<dim> ofSimplex(
      referenceShape<dim>(isPlane ? CellType::triangle6 : CellType::tetrahedron10)),
      ofBrick(referenceShape<dim>(isPlane ? CellType::quadrilateral9 : CellType::hexahedron27));
  return shape.isSimplex ? ofSimplex : ofBrick;
}

template <int dim>
double leastDeterminantOf(const Shape<dim>& shape, std::span<const Point> points) {
  const Bernstein<dim>& basis = basisOf(shape);
  constexpr int mostHalvings = 5 * dim;
  const auto corners = relativeCorners<dim>(points);
  const auto determinant = [&](const Coordinates<dim>& xi) {
    return ElementMap<dim>(corners, shape.sampleAt(xi)).determinant();
  };
  std::vector<Part<dim>> parts(1);
  const auto inBrick = [&](const Coordinates<dim>& at) { return determinant(carried(shape, at)); };
  double sound = determinant(shape.centre()); // bound on the parts that are settled
  for (int halving = 0;; ++halving) {
    std::vector<Part<dim>> doubtful;
    double doubt = sound;
    for (const Part<dim>& part : parts) {
      const auto [value, coefficient] = basis.least(part, inBrick);
      if (value <= 0)
        return value;
      if (coefficient > 0)
        sound = std::min(sound, coefficient);
      else
        doubtful.push_back(part);
      doubt = std::min(doubt, coefficient);
    }
    if (doubtful.empty())
      return sound;
    if (halving == mostHalvings)
      return doubt;
    parts.clear();
    for (const Part<dim>& part : doubtful)
      for (const Part<dim>& half : part.halves(shape.isSimplex))
        parts.push_back(half);
  }
}

/// The nodes of the same element with inner nodes.
std::vector<Point> withInnerPoints(CellType type, std::span<const Point> points) {
  return withShape(type, [&]<int dim>(const Shape<dim>& shape) {
    const Shape<dim>& whole = referenceShape<dim>(withInnerNodes(type));
    std::vector<Point> all(points.begin(), points.end());
    for (int inner = shape.numNodes; inner < whole.numNodes; ++inner) {
      const NodalValues values = shape.values(whole.node(inner));
      Point& point = all.emplace_back();
      for (std::size_t a = 0; a < points.size(); ++a)
        for (std::size_t d = 0; d < 3; ++d)
          point[d] += values[a] * points[a][d];
    }
    return all;
  });
}

} // namespace

double leastDeterminant(CellType type, std::span<const Point> points) {
  assert(orderOf(type) == 2);
  if (isSerendipity(type))
    return leastDeterminant(withInnerNodes(type), withInnerPoints(type, points));
  return withShape(type, [&](const auto& shape) { return leastDeterminantOf(shape, points); });
}

} // namespace epafi::mesh
