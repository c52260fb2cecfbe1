#include "epafi/fem/JacobianBound.hpp"

#include "epafi/fem/ElementMap.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace epafi::fem {
namespace {

/// A part of a reference element: origin + axes · ξ for all ξ of the whole.
template <class Shape>
struct Part {
  static constexpr int dim = Shape::dimension;
  typename Shape::Coordinates origin = Shape::Coordinates::Zero();
  Eigen::Matrix<double, dim, dim> axes = Eigen::Matrix<double, dim, dim>::Identity();

  /// Both halves: of a brick across its longest axis, of a simplex across its longest edge.
  [[nodiscard]] std::array<Part, 2> halves() const {
    std::array<Part, 2> both{*this, *this};
    if constexpr (!Shape::isSimplex) {
      Eigen::Index axis = 0;
      axes.colwise().squaredNorm().maxCoeff(&axis);
      for (int side = 0; side < 2; ++side) {
        both[static_cast<std::size_t>(side)].axes.col(axis) *= 0.5;
        both[static_cast<std::size_t>(side)].origin += (side - 0.5) * axes.col(axis);
      }
    } else {
      const auto [a, b] = longestEdge();
      const typename Shape::Coordinates middle = 0.5 * (corner(a) + corner(b));
      both[0].moveCorner(a, middle);
      both[1].moveCorner(b, middle);
    }
    return both;
  }

private:
  [[nodiscard]] typename Shape::Coordinates corner(int number) const {
    return number == 0 ? origin : typename Shape::Coordinates(origin + axes.col(number - 1));
  }
  void moveCorner(int number, const typename Shape::Coordinates& to) {
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

/// Bernstein's basis of the polynomials that determinants are.
template <class Shape>
class Bernstein {
public:
  using Coordinates = typename Shape::Coordinates;

  Bernstein() {
    std::vector<Exponents> all;
    for (int code = 0; code < power(degree + 1, dim); ++code) {
      Exponents exponents{};
      exponents.back() = degree;
      for (std::size_t i = 0, left = static_cast<std::size_t>(code); i < dim; ++i, left /= degree + 1)
        exponents.back() -= exponents[i] = static_cast<int>(left % (degree + 1));
      if (Shape::isSimplex && exponents.back() < 0)
        continue;
      all.push_back(exponents);
      Coordinates point;
      for (std::size_t i = 0; i < dim; ++i)
        point[static_cast<Eigen::Index>(i)] = static_cast<double>(exponents[i]) / degree;
      points_.push_back(Shape::isSimplex ? point : Coordinates(2 * point - Coordinates::Ones()));
    }
    Eigen::MatrixXd values(all.size(), all.size());
    for (std::size_t row = 0; row < all.size(); ++row)
      for (std::size_t column = 0; column < all.size(); ++column)
        values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
            at(points_[row], all[column]);
    toCoefficients_ = values.inverse();
  }

  /// Least value at the points of a part, and least coefficient there.
  template <class Polynomial>
  std::pair<double, double> least(const Part<Shape>& part, const Polynomial& polynomial) const {
    Eigen::VectorXd values(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = polynomial(part.origin + part.axes * points_[i]);
    return {values.minCoeff(), (toCoefficients_ * values).minCoeff()};
  }

private:
  static constexpr int dim = Shape::dimension;
  /// Altogether on simplices, in each coordinate on bricks: of a product of `dim` derivatives.
  static constexpr int degree = Shape::isSimplex ? dim * (Shape::order - 1) : dim * Shape::order - 1;
  /// The last one: what is left of the degree, on simplices.
  using Exponents = std::array<int, static_cast<std::size_t>(dim) + 1>;

  static double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }
  static double at(const Coordinates& xi, const Exponents& exponents) {
    double value = 1;
    for (int i = 0; i < dim; ++i) {
      const int k = exponents[static_cast<std::size_t>(i)];
      const double x = Shape::isSimplex ? xi[i] : 0.5 * (1 + xi[i]);
      value *= std::pow(x, k) / factorial(k);
      if (!Shape::isSimplex)
        value *= factorial(degree) * std::pow(1 - x, degree - k) / factorial(degree - k);
    }
    return Shape::isSimplex ? value * factorial(degree) * std::pow(1 - xi.sum(), exponents.back()) /
                                  factorial(exponents.back())
                            : value;
  }

  std::vector<Coordinates> points_;
  Eigen::MatrixXd toCoefficients_;
};

template <class Shape>
double leastDeterminantOf(std::span<const Point> points) {
  static const Bernstein<Shape> basis;
  constexpr int mostHalvings = 5 * Shape::dimension;
  const auto corners = relativeCorners<Shape>(points);
  const auto determinant = [&](const typename Shape::Coordinates& xi) {
    return ElementMap<Shape>(corners, sampleAt<Shape>(xi)).determinant();
  };
  std::vector<Part<Shape>> parts(1);
  double sound = determinant(Shape::centre()); // bound on the parts that are settled
  for (int halving = 0;; ++halving) {
    std::vector<Part<Shape>> doubtful;
    double doubt = sound;
    for (const Part<Shape>& part : parts) {
      const auto [value, coefficient] = basis.least(part, determinant);
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
    for (const Part<Shape>& part : doubtful)
      for (const Part<Shape>& half : part.halves())
        parts.push_back(half);
  }
}

} // namespace

double leastDeterminant(CellType type, std::span<const Point> points) {
  return withShape(type, [&](auto shape) {
    using Shape = decltype(shape);
    if constexpr (Shape::order == 1)
      return 0.0;
    else
      return leastDeterminantOf<Shape>(points);
  });
}

} // namespace epafi::fem
