#include "AccuracyReport.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace epafi::drivers {
namespace {

using Entries = std::vector<std::string>;

/// Rows of one variant, problem by problem, from coarse to fine.
std::vector<Row> series(const Table& table, const std::string& variant) {
  std::vector<Row> all;
  std::vector<std::string> problems;
  for (const Row& first : table.rows) {
    const std::string& problem = first.text("problem");
    if (std::find(problems.begin(), problems.end(), problem) != problems.end())
      continue;
    problems.push_back(problem);
    std::vector<Row> rows;
    for (const Row& row : table.rows)
      if (row.text("problem") == problem && row.text("variant") == variant)
        rows.push_back(row);
    std::sort(rows.begin(), rows.end(),
              [](const Row& a, const Row& b) { return a.number("elements") < b.number("elements"); });
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

/// Of the same problem, on elements of the same order.
bool areComparable(const Row& row, const Row& other) {
  return other.text("problem") == row.text("problem") && other.number("order") == row.number("order");
}

bool isFinest(const Row& row, const Table& table) {
  return std::none_of(table.rows.begin(), table.rows.end(), [&](const Row& other) {
    return areComparable(row, other) && other.number("elements") > row.number("elements");
  });
}

bool isLadder(const Row& row) {
  return row.text("variant").starts_with("ladder_");
}

std::string digits(const Row& row, const std::string& column) {
  return inDigits(row.number(column));
}

std::string milliseconds(const Row& row, const std::string& column = "seconds") {
  return inDigits(1e3 * row.number(column));
}

/// What `other` saves beside `row`: 0.314 as "31 %".
std::string saved(const Row& row, const Row& other, const std::string& column) {
  return std::to_string(std::lround(100 * (1 - other.number(column) / row.number(column)))) + " %";
}

/// Of errors on two meshes; a dash for errors that are none, nothing for the first mesh.
std::string order(const Row* coarse, const Row& fine, const std::string& column) {
  constexpr double noError = 1e-9;
  if (coarse == nullptr || !areComparable(*coarse, fine))
    return "";
  const double before = coarse->number(column), after = fine.number(column);
  return before > noError && after > noError ? inDigits(std::log2(before / after)) : "–";
}

/// A table with problem and mesh first; rows that have no entries are left out.
std::string report(const std::string& title, const std::string& names, const std::vector<Row>& rows,
                   const std::function<Entries(const Row&)>& entriesOf) {
  std::string text = title + ":\n\n" + markdownHeading("problem | elements a side | " + names);
  for (const Row& row : rows)
    if (Entries entries = entriesOf(row); !entries.empty()) {
      entries.insert(entries.begin(), {row.text("problem") + (row.number("order") > 1 ? ", order 2" : ""),
                                       count(row.number("elements"))});
      text += markdownLine(entries);
    }
  return text + "\n";
}

std::string frontReport(const Table& table) {
  return report("The default beside the front",
                "default: ms | times the front's | on the front | fastest with that error | ms",
                series(table, "default"), [&](const Row& row) -> Entries {
                  const Row& fastest = fastestLike(row, table);
                  return {milliseconds(row), inDigits(row.number("seconds") / fastest.number("seconds")),
                          row.number("on_pareto_front") == 1 ? "yes" : "", fastest.text("variant"),
                          milliseconds(fastest)};
                });
}

/// Times at the same error.
std::string orderReport(const Table& table) {
  return report("Order 2 beside order 1",
                "unknowns | energy error | ms | order 2: elements a side | unknowns | energy error | ms | "
                "time of order 1 by that of 2",
                series(table, "default"), [&](const Row& row) -> Entries {
                  const std::vector<Row> quadratic = series(table, "quadratic");
                  const Row* best = nullptr;
                  for (const Row& other : quadratic)
                    if (other.text("problem") == row.text("problem") &&
                        other.number("energy_error") <= row.number("energy_error") &&
                        (best == nullptr || other.number("seconds") < best->number("seconds")))
                      best = &other;
                  if (best == nullptr)
                    return {};
                  return {count(row.number("unknowns")),
                          digits(row, "energy_error"),
                          milliseconds(row),
                          count(best->number("elements")),
                          count(best->number("unknowns")),
                          digits(*best, "energy_error"),
                          milliseconds(*best),
                          inDigits(row.number("seconds") / best->number("seconds"))};
                });
}

/// The row of another variant on the same mesh, or null.
const Row* beside(const Row& row, const char* variant, const Table& table) {
  Row like = row;
  like["variant"] = variant;
  return table.find(like, {"problem", "order", "variant", "elements"});
}

std::string balanceReport(const Table& table) {
  return report(
      "Balanced stopping",
      "products at 1e-6 | balanced | saved | error over that at 1e-6 | ms at 1e-6 | balanced ms | saved",
      series(table, "default"), [&](const Row& fixed) -> Entries {
        const Row* balanced = beside(fixed, "balanced", table);
        if (balanced == nullptr)
          return {};
        const char* products = "hessian_multiplications";
        return {digits(fixed, products),
                digits(*balanced, products),
                saved(fixed, *balanced, products),
                inDigits(balanced->number("energy_error") / fixed.number("energy_error")),
                milliseconds(fixed),
                milliseconds(*balanced),
                saved(fixed, *balanced, "seconds")};
      });
}

std::string nestedReport(const Table& table) {
  return report(
      "Nested starts",
      "products, balanced | nested | saved | iteration's ms, balanced | nested | saved | ms of this mesh, "
      "balanced | nested | saved",
      series(table, "balanced"), [&](const Row& balanced) -> Entries {
        const Row* nested = beside(balanced, "nested", table);
        const char* products = "hessian_multiplications";
        if (nested == nullptr || nested->number("all_multiplications") == nested->number(products))
          return {}; // there is no coarser mesh to start from
        Entries entries{digits(balanced, products), digits(*nested, products),
                        saved(balanced, *nested, products)};
        for (const char* time : {"solve_seconds", "finest_seconds"})
          entries.insert(entries.end(), {milliseconds(balanced, time), milliseconds(*nested, time),
                                         saved(balanced, *nested, time)});
        return entries;
      });
}

std::string convergenceReport(const Table& table) {
  const Row* before = nullptr;
  std::vector<Row> rows = series(table, "tolerance_1e-10");
  for (const Row& row : series(table, "quadratic_1e-10"))
    rows.push_back(row);
  return report(
      "Errors of the meshes, the iteration's at 1e-10",
      "unknowns | energy error | order | L2 error | order | contact zone | contact force | estimated | "
      "effectivity",
      rows, [&](const Row& row) -> Entries {
        Entries entries{count(row.number("unknowns")),      digits(row, "energy_error"),
                        order(before, row, "energy_error"), digits(row, "l2_error"),
                        order(before, row, "l2_error"),     digits(row, "contact_zone_error"),
                        digits(row, "force_error"),         digits(row, "estimated_discretisation_error"),
                        digits(row, "effectivity")};
        before = &row;
        return entries;
      });
}

std::string variantsReport(const Table& table) {
  return report(
      "All variants, finest mesh",
      "variant | tolerance | products with F | on all meshes | ms | times the front's | on the front | "
      "energy error | of which iteration | digits | digits of efficacy | unknowns a second",
      table.rows, [&](const Row& row) -> Entries {
        if (isLadder(row) || !isFinest(row, table))
          return {};
        return {row.text("variant"),
                row.text("tolerance"),
                digits(row, "hessian_multiplications"),
                digits(row, "all_multiplications"),
                milliseconds(row),
                inDigits(row.number("seconds") / fastestLike(row, table).number("seconds")),
                row.number("on_pareto_front") == 1 ? "yes" : "",
                digits(row, "energy_error"),
                digits(row, "algebraic_error"),
                digits(row, "digits_of_accuracy"),
                digits(row, "digits_of_efficacy"),
                digits(row, "unknowns_per_second")};
      });
}

} // namespace

std::string accuracyReport(const Table& table) {
  return frontReport(table) + orderReport(table) + balanceReport(table) + nestedReport(table) +
         convergenceReport(table) + variantsReport(table);
}

std::string digitsReport(const Table& table) {
  return report(
      "Digits of the iteration",
      "preconditioner | tolerance | products with F | algebraic error | its estimate | energy error",
      table.rows, [&](const Row& row) -> Entries {
        if (!isLadder(row))
          return {};
        return {row.text("variant").substr(row.text("variant").find('_') + 1),
                row.text("tolerance"),
                digits(row, "hessian_multiplications"),
                digits(row, "algebraic_error"),
                digits(row, "estimated_algebraic_error"),
                digits(row, "energy_error")};
      });
}

} // namespace epafi::drivers
