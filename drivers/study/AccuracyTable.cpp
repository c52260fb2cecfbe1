#include "AccuracyTable.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::drivers {

Table accuracyTable() {
  return Table(
      "problem,variant,order,elements,tolerance,unknowns,seconds,hessian_multiplications,energy_error,"
      "algebraic_error,estimated_error,on_pareto_front,discretisation_error,l2_error,contact_zone_error,"
      "force_error,estimated_discretisation_error,estimated_algebraic_error,effectivity,all_multiplications,"
      "finest_seconds,solve_seconds,digits_of_accuracy,digits_of_efficacy,digits_of_size,"
      "unknowns_per_second,repeats,status");
}

void addDigits(Row& row) {
  const auto set = [&](const char* column, double value) {
    row[column] = std::isfinite(value) ? value : notMeasured;
  };
  const double error = row.number("energy_error"), seconds = row.number("seconds"),
               unknowns = row.number("unknowns");
  set("estimated_algebraic_error", row.number("estimated_algebraic_error"));
  set("effectivity", row.number("estimated_discretisation_error") / row.number("discretisation_error"));
  set("digits_of_accuracy", -std::log10(error));
  set("digits_of_efficacy", -std::log10(error * seconds));
  set("digits_of_size", std::log10(unknowns));
  set("unknowns_per_second", unknowns / seconds);
}

void markFront(Table& table) {
  for (Row& row : table.rows)
    row["on_pareto_front"] = std::isfinite(row.number("seconds")) &&
                             std::none_of(table.rows.begin(), table.rows.end(), [&](const Row& other) {
                               return other.text("problem") == row.text("problem") &&
                                      other.number("seconds") < row.number("seconds") &&
                                      other.number("energy_error") <= row.number("energy_error");
                             });
}

const Row& fastestLike(const Row& row, const Table& table) {
  constexpr double equalErrors = 1.02; // errors this much apart are taken as equal
  const Row* fastest = &row;
  for (const Row& other : table.rows)
    if (other.text("problem") == row.text("problem") && other.number("order") == row.number("order") &&
        other.number("energy_error") <= equalErrors * row.number("energy_error") &&
        other.number("seconds") < fastest->number("seconds"))
      fastest = &other;
  return *fastest;
}

} // namespace epafi::drivers
