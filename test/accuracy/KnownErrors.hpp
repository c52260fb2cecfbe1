#pragma once

/// Problems whose errors are known on every mesh.

#include "epafi/accuracy/AccuracyLoop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace epafi::accuracy::test {

/// Patches in the plane or in space of any number of equal elements each: an exact solution of energy 1 whose
/// error on a patch is η² = c |patch| h^(2p) c_p², h the size of its elements, which refinement makes exactly
/// as small as is wanted. What a finer mesh adds is orthogonal to what is left.
class Patches : public RefinableProblem {
public:
  /// \param variety  how many different c there are
  explicit Patches(int dimension = 2, int variety = 5) : dimension_(dimension) {
    for (int patch = 0; patch < 16; ++patch) {
      weights_.push_back(std::exp2(patch % variety));
      sizes_.push_back(0.25);
    }
    const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    for (double& weight : weights_)
      weight /= sum;
  }

  std::array<double, 2> constants{1, 1}; ///< c_p of the error, for elements of order 1 and 2
  double estimateByError = 1;            ///< what the estimate really is
  double believed = 1;                   ///< and what is known of it beforehand
  bool knowsChange = true;
  double surprise = 1;                       ///< error by what was foreseen, on all meshes but the first
  std::size_t failing = 99;                  ///< mesh whose iteration fails
  double algebraic = 0;                      ///< error of the iteration
  bool hasQuantity = false;                  ///< 1 less η² in all, its bar what is left
  std::vector<double> errors;                ///< in truth, of each mesh
  mutable std::vector<RefinementGoal> goals; ///< that plan() was given

  [[nodiscard]] int dimension() const override { return dimension_; }
  [[nodiscard]] double effectivity(int /*order*/) const override { return believed; }

  MeshResult solve(int order) override {
    MeshResult result;
    double elements = 0, squared = 0;
    const double factor = errors.empty() ? 1 : surprise;
    for (std::size_t patch = 0; patch < sizes_.size(); ++patch) {
      const double own = std::pow(factor * constants.at(static_cast<std::size_t>(order) - 1) *
                                      std::pow(sizes_[patch], order),
                                  2) *
                         weights_[patch];
      squared += own;
      result.elements.squared.push_back(own * estimateByError * estimateByError);
      result.elements.measures.push_back(1.0 / 16);
      elements += std::pow(0.25 / sizes_[patch], dimension_);
    }
    const double perElement = order == 1 ? 1 : std::exp2(dimension_);
    result.order = order;
    result.unknowns = std::llround(1000 * elements * perElement);
    result.energyNorm = std::sqrt(1 - squared);
    result.discretisation = estimateByError * std::sqrt(squared);
    result.algebraic = algebraic;
    result.seconds = 1e-3 * static_cast<double>(result.unknowns);
    result.bytes = 1e3 * static_cast<double>(result.unknowns);
    if (knowsChange && !errors.empty())
      result.change = std::sqrt(std::max(0.0, errors.back() * errors.back() - squared));
    if (hasQuantity)
      result.quantity = {1 - squared, estimateByError * estimateByError * squared, algebraic};
    if (errors.size() == failing)
      result.failure = "it stagnated";
    errors.push_back(std::sqrt(squared));
    return result;
  }

  [[nodiscard]] WantedSizes plan(const MeshResult& result, const RefinementGoal& goal) const override {
    goals.push_back(goal);
    return RefinableProblem::plan(result, goal);
  }

  std::vector<LocalOrdinal> refine(const WantedSizes& wanted) override {
    for (std::size_t patch = 0; patch < sizes_.size(); ++patch)
      sizes_[patch] *= std::exp2(-wanted.halvings[patch]);
    std::vector<LocalOrdinal> ancestors(sizes_.size());
    std::iota(ancestors.begin(), ancestors.end(), 0);
    return ancestors;
  }

private:
  int dimension_;
  std::vector<double> weights_, sizes_;
};

/// A number that nears 1 by a factor from mesh to mesh, with bars that are a third of the last one.
class Drift : public Patches {
public:
  explicit Drift(double factor) : factor_(factor) {}
  MeshResult solve(int order) override {
    const auto number = static_cast<double>(errors.size());
    MeshResult result = Patches::solve(order);
    result.quantity = {1 + std::pow(factor_, number), std::pow(3.0, -number), 0};
    return result;
  }

private:
  double factor_;
};

/// A number that looks at one element, and grows by a power of its size to a limit of its own, or without
/// one.
class Peak : public Patches {
public:
  Peak(double power, double limit) : power_(power), limit_(limit) {}
  MeshResult solve(int order) override {
    MeshResult result = Patches::solve(order);
    const double width = 10 / std::sqrt(static_cast<double>(result.unknowns));
    const double value = std::pow(std::hypot(width, limit_), -power_);
    result.quantity = {value, value, 0, width};
    return result;
  }

private:
  double power_, limit_;
};

/// A square in rectangles, with a solution that goes like r^α at the origin: η² = c² h^(2p) r^(2(α − 1 − p))
/// |K|. Elements are halved across their longer side, so that the mesh is seldom just what is wanted.
class Corner : public RefinableProblem {
public:
  static constexpr double alpha = 0.5;
  struct Rectangle {
    double x, y, width, height;
    [[nodiscard]] double area() const { return width * height; }
  };
  std::vector<Rectangle> elements;

  Corner() {
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        elements.push_back({0.25 * i, 0.25 * j, 0.25, 0.25});
  }
  [[nodiscard]] int dimension() const override { return 2; }
  MeshResult solve(int order) override {
    MeshResult result;
    double sum = 0;
    for (const Rectangle& element : elements) {
      const double r = std::hypot(element.x + element.width / 2, element.y + element.height / 2);
      const double squared =
          0.25 * std::pow(element.area(), order + 1) * std::pow(r, 2 * (alpha - 1 - order));
      result.elements.squared.push_back(squared);
      result.elements.measures.push_back(element.area());
      sum += squared;
    }
    result.order = order;
    result.unknowns = static_cast<GlobalOrdinal>(elements.size()) * (order == 1 ? 1 : 4);
    result.discretisation = std::sqrt(sum);
    result.energyNorm = std::sqrt(1 - sum);
    if (last_ > 0)
      result.change = std::sqrt(std::max(0.0, last_ - sum));
    last_ = sum;
    return result;
  }
  std::vector<LocalOrdinal> refine(const WantedSizes& wanted) override {
    std::vector<Rectangle> parts;
    std::vector<LocalOrdinal> ancestors;
    for (std::size_t e = 0; e < elements.size(); ++e)
      halve(elements[e], std::lround(2 * wanted.halvings[e]), parts);
    for (const Rectangle& part : parts)
      for (std::size_t e = 0; e < elements.size(); ++e)
        if (const Rectangle& old = elements[e];
            part.x >= old.x && part.x < old.x + old.width && part.y >= old.y && part.y < old.y + old.height)
          ancestors.push_back(static_cast<LocalOrdinal>(e));
    elements = parts;
    return ancestors;
  }

private:
  static void halve(const Rectangle& whole, long times, std::vector<Rectangle>& parts) {
    if (times <= 0) {
      parts.push_back(whole);
      return;
    }
    Rectangle first = whole, second = whole;
    if (whole.width >= whole.height) {
      first.width = second.width = whole.width / 2;
      second.x += first.width;
    } else {
      first.height = second.height = whole.height / 2;
      second.y += first.height;
    }
    halve(first, times - 1, parts);
    halve(second, times - 1, parts);
  }

  double last_ = 0;
};

} // namespace epafi::accuracy::test
