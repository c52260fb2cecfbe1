#include "ClosedMembranes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

namespace epafi::drivers {
namespace {

/// Entries of the Q1 element's stiffness on a square, by the number of coordinates in which the two nodes differ.
constexpr std::array<double, 3> stiffness{2.0 / 3, -1.0 / 6, -1.0 / 3};

/// One row of K while its elements are added up. A node of both bodies has 8 neighbours, or 9 at the end of the
/// contact zone.
class Row {
public:
  void add(int column, double value) {
    const auto end = columns_.begin() + size_;
    const auto place = std::find(columns_.begin(), end, column);
    if (place == end) {
      columns_[static_cast<std::size_t>(size_)] = column;
      values_[static_cast<std::size_t>(size_++)] = value;
    } else {
      values_[static_cast<std::size_t>(place - columns_.begin())] += value;
    }
  }

  void appendTo(SparseSystem& system) const {
    std::array<int, capacity> order{};
    const auto end = order.begin() + size_;
    std::iota(order.begin(), end, 0);
    const auto column = [this](int k) { return columns_[static_cast<std::size_t>(k)]; };
    std::sort(order.begin(), end, [&](int a, int b) { return column(a) < column(b); });
    for (auto k = order.begin(); k != end; ++k) {
      system.columns.push_back(column(*k));
      system.values.push_back(values_[static_cast<std::size_t>(*k)]);
    }
    system.rowStarts.push_back(static_cast<int>(system.columns.size()));
  }

private:
  static constexpr std::size_t capacity = 12;
  std::array<int, capacity> columns_{};
  std::array<double, capacity> values_{};
  int size_ = 0;
};

class Assembly {
public:
  explicit Assembly(const MembraneChoice& choice)
      : coercive_(choice.coercive), n_(choice.elements), closed_(choice.closedNodes),
        width_(choice.coercive ? n_ : n_ + 1) {}

  SparseSystem run() {
    const auto size = static_cast<std::size_t>((n_ + 1) * (n_ + width_) - closed_);
    system_.load.reserve(size);
    system_.rowStarts.reserve(size + 1);
    system_.columns.reserve(9 * size);
    system_.values.reserve(9 * size);
    system_.rowStarts.push_back(0);
    for (int j = 0; j <= n_; ++j)
      for (int i = 1; i <= n_; ++i)
        addNode(0, i, j);
    for (int j = 0; j <= n_; ++j)
      for (int i = j < closed_ ? 1 : 0; i < width_; ++i)
        addNode(1, i, j);
    return std::move(system_);
  }

private:
  /// Unknown of node (i,j) of a body, −1 if it is supported. Nodes count row by row, body by body.
  [[nodiscard]] int unknown(int body, int i, int j) const {
    if (body == 0)
      return i == 0 ? -1 : j * n_ + i - 1;
    if (i == 0 && j < closed_)
      return unknown(0, n_, j);
    return i == width_ ? -1 : n_ * (n_ + 1) + j * width_ + i - std::min(j + 1, closed_);
  }

  [[nodiscard]] double density(int body, int elementRow) const {
    if (body == 0)
      return 4 * elementRow >= 3 * n_ ? (coercive_ ? -1.0 : -5.0) : 0.0;
    return 4 * elementRow < n_ ? (coercive_ ? -3.0 : -1.0) : 0.0;
  }

  void addNode(int body, int i, int j) {
    Row row;
    double load = addElements(row, body, i, j);
    if (body == 0 && i == n_ && j < closed_)
      load += addElements(row, 1, 0, j);
    row.appendTo(system_);
    system_.load.push_back(load);
  }

  /// Adds the elements of one body that touch its node (i,j); returns their load on it.
  double addElements(Row& row, int body, int i, int j) const {
    const double quarter = 0.25 / (static_cast<double>(n_) * n_);
    double load = 0;
    for (int y = std::max(j - 1, 0); y <= std::min(j, n_ - 1); ++y)
      for (int x = std::max(i - 1, 0); x <= std::min(i, n_ - 1); ++x) {
        load += quarter * density(body, y);
        for (const int b : {y, y + 1})
          for (const int a : {x, x + 1})
            if (const int column = unknown(body, a, b); column >= 0)
              row.add(column, stiffness[(a == i ? 0U : 1U) + (b == j ? 0U : 1U)]);
      }
    return load;
  }

  bool coercive_;
  int n_, closed_;
  int width_; ///< free nodes a row of the second body, the contact line included
  SparseSystem system_;
};

} // namespace

std::vector<double> SparseSystem::product(const std::vector<double>& u) const {
  std::vector<double> result(load.size());
  for (std::size_t row = 0; row < load.size(); ++row) {
    double sum = 0;
    for (auto k = static_cast<std::size_t>(rowStarts[row]); k < static_cast<std::size_t>(rowStarts[row + 1]);
         ++k)
      sum += values[k] * u[static_cast<std::size_t>(columns[k])];
    result[row] = sum;
  }
  return result;
}

SparseSystem closedMembranes(const MembraneChoice& choice) {
  return Assembly(choice).run();
}

} // namespace epafi::drivers
