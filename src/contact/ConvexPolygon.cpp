#include "epafi/contact/ConvexPolygon.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

namespace epafi::contact {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// Points and weights of Gauss' rule on (0, 1): zeros of Legendre's polynomial by Newton's method.
std::vector<std::pair<double, double>> gaussRule(int number) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < number; ++i) {
    double x = -std::cos(std::numbers::pi * (i + 0.75) / (number + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double value = 1, before = 0;
      for (int k = 1; k <= number; ++k)
        before = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * before) / k);
      slope = number * (x * value - before) / (x * x - 1);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-15)
        break;
    }
    rule.emplace_back(0.5 * (1 + x), 1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

std::vector<SimplexPoint> makeRule(int dimension, int degree) {
  const auto gauss = gaussRule((degree + 1 + dimension) / 2);
  std::vector<SimplexPoint> rule;
  for (const auto& [x, weight] : gauss) {
    if (dimension == 1) {
      rule.push_back({{x, 0}, weight});
      continue;
    }
    for (const auto& [y, across] : gauss)
      rule.push_back({{x, (1 - x) * y}, 2 * weight * across * (1 - x)});
  }
  return rule;
}

} // namespace

double areaOf(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return twice / 2;
}

void clip(Polygon& polygon, const Polygon& window, Polygon& work) {
  for (std::size_t e = 0; e < window.size() && !polygon.empty(); ++e) {
    const Vector2d &from = window[e], along = window[(e + 1) % window.size()] - from;
    work.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
      const double a = cross(along, here - from), b = cross(along, next - from); // ≥ 0: inside
      if (a >= 0)
        work.push_back(here);
      if ((a > 0 && b < 0) || (a < 0 && b > 0))
        work.emplace_back(here + a / (a - b) * (next - here));
    }
    polygon.swap(work);
  }
}

bool contains(const Polygon& polygon, const Vector2d& point, double margin) {
  for (std::size_t e = 0; e < polygon.size(); ++e) {
    const Vector2d along = polygon[(e + 1) % polygon.size()] - polygon[e];
    if (cross(along, point - polygon[e]) < -margin * along.norm())
      return false;
  }
  return true;
}

const std::vector<SimplexPoint>& simplexRule(int dimension, int degree) {
  static std::map<std::pair<int, int>, std::vector<SimplexPoint>> rules;
  auto [place, isNew] = rules.try_emplace({dimension, degree});
  if (isNew)
    place->second = makeRule(dimension, degree);
  return place->second;
}

} // namespace epafi::contact
