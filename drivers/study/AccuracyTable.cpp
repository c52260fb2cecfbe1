#include "AccuracyTable.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

namespace epafi::drivers {
namespace {

struct Column {
  const char* name;
  std::function<double(const AccuracyRow&)> value;
};

/// The columns after problem, variant, elements and tolerance.
const std::vector<Column>& columns() {
  static const std::vector<Column> all{
      {"unknowns", [](const AccuracyRow& r) { return r.unknowns; }},
      {"seconds", [](const AccuracyRow& r) { return r.seconds; }},
      {"hessian_multiplications", [](const AccuracyRow& r) { return r.products; }},
      {"energy_error", [](const AccuracyRow& r) { return r.energyError; }},
      {"algebraic_error", [](const AccuracyRow& r) { return r.algebraicError; }},
      {"estimated_error", [](const AccuracyRow& r) { return r.estimatedError; }},
      {"on_pareto_front", [](const AccuracyRow& r) { return r.isOnFront ? 1.0 : 0.0; }},
      {"discretisation_error", [](const AccuracyRow& r) { return r.discretisationError; }},
      {"l2_error", [](const AccuracyRow& r) { return r.l2Error; }},
      {"contact_zone_error", [](const AccuracyRow& r) { return r.zoneError; }},
      {"force_error", [](const AccuracyRow& r) { return r.forceError; }},
      {"estimated_discretisation_error", [](const AccuracyRow& r) { return r.estimatedDiscretisation; }},
      {"estimated_algebraic_error", [](const AccuracyRow& r) { return r.estimatedAlgebraic; }},
      {"effectivity", [](const AccuracyRow& r) { return r.effectivity(); }},
      {"all_multiplications", [](const AccuracyRow& r) { return r.allProducts; }},
      {"finest_seconds", [](const AccuracyRow& r) { return r.finestSeconds; }},
      {"solve_seconds", [](const AccuracyRow& r) { return r.solveSeconds; }},
      {"digits_of_accuracy", [](const AccuracyRow& r) { return r.digitsOfAccuracy(); }},
      {"digits_of_efficacy", [](const AccuracyRow& r) { return r.digitsOfEfficacy(); }},
      {"digits_of_size", [](const AccuracyRow& r) { return r.digitsOfSize(); }},
      {"unknowns_per_second", [](const AccuracyRow& r) { return r.unknowns / r.seconds; }},
      {"repeats", [](const AccuracyRow& r) { return r.repeats; }},
  };
  return all;
}

} // namespace

double AccuracyRow::digitsOfAccuracy() const {
  return -std::log10(energyError);
}

double AccuracyRow::digitsOfEfficacy() const {
  return -std::log10(energyError * seconds);
}

double AccuracyRow::digitsOfSize() const {
  return std::log10(unknowns);
}

const AccuracyRow* AccuracyTable::find(const std::string& problem, const std::string& variant,
                                       int elements) const {
  const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const AccuracyRow& row) {
    return row.problem == problem && row.variant == variant && row.elements == elements;
  });
  return found == rows_.end() ? nullptr : &*found;
}

void AccuracyTable::markFront() {
  for (AccuracyRow& row : rows_)
    row.isOnFront = std::isfinite(row.seconds) &&
                    std::none_of(rows_.begin(), rows_.end(), [&row](const AccuracyRow& other) {
                      return other.problem == row.problem && other.seconds < row.seconds &&
                             other.energyError <= row.energyError;
                    });
}

const AccuracyRow& AccuracyTable::fastestLike(const AccuracyRow& row) const {
  const AccuracyRow* fastest = &row;
  for (const AccuracyRow& other : rows_)
    if (other.problem == row.problem && other.energyError <= equalErrors * row.energyError &&
        other.seconds < fastest->seconds)
      fastest = &other;
  return *fastest;
}

double AccuracyTable::distanceToFront(const AccuracyRow& row) const {
  return row.seconds / fastestLike(row).seconds;
}

std::string AccuracyTable::csv() const {
  std::ostringstream text;
  text << "problem,variant,elements,tolerance";
  for (const Column& column : columns())
    text << ',' << column.name;
  text << ",status\n";
  for (const AccuracyRow& row : rows_) {
    text << row.problem << ',' << row.variant << ',' << row.elements << ',' << row.tolerance;
    for (const Column& column : columns()) {
      const double value = column.value(row);
      text << ',';
      if (std::isfinite(value))
        text << value;
    }
    text << ',' << row.status << '\n';
  }
  return text.str();
}

} // namespace epafi::drivers
