#include "AccuracyReport.hpp"

#include "AccuracyCase.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace epafi::drivers {
namespace {

std::vector<std::string> problemsOf(const AccuracyTable& table) {
  std::vector<std::string> names;
  for (const AccuracyRow& row : table.rows())
    if (std::find(names.begin(), names.end(), row.problem) == names.end())
      names.push_back(row.problem);
  return names;
}

/// Rows of one problem and variant, from coarse to fine.
std::vector<AccuracyRow> series(const AccuracyTable& table, const std::string& problem,
                                const std::string& variant) {
  std::vector<AccuracyRow> rows;
  for (const AccuracyRow& row : table.rows())
    if (row.problem == problem && row.variant == variant)
      rows.push_back(row);
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.elements < b.elements; });
  return rows;
}

int finestOf(const AccuracyTable& table, const std::string& problem) {
  int elements = 0;
  for (const AccuracyRow& row : table.rows())
    if (row.problem == problem)
      elements = std::max(elements, row.elements);
  return elements;
}

bool isLadder(const AccuracyRow& row) {
  return row.variant.rfind(ladderName, 0) == 0;
}

/// Three digits; a dash where nothing was measured.
std::string number(double value) {
  if (!std::isfinite(value))
    return "–";
  std::ostringstream text;
  text << std::setprecision(3) << value;
  return text.str();
}

/// 0.314 as "31 %".
std::string percent(double share) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << 100 * share << " %";
  return text.str();
}

std::string line(const std::vector<std::string>& entries) {
  std::string text = "|";
  for (const std::string& entry : entries)
    text += " " + entry + " |";
  return text + "\n";
}

std::string heading(const std::vector<std::string>& names) {
  return line(names) + line(std::vector<std::string>(names.size(), "---"));
}

/// Of errors on two meshes; a dash for errors that are none.
std::string order(double coarse, double fine) {
  constexpr double noError = 1e-9;
  return coarse > noError && fine > noError ? number(std::log2(coarse / fine)) : "–";
}

} // namespace

std::string convergenceReport(const AccuracyTable& table) {
  std::string text = heading({"problem", "elements a side", "unknowns", "energy error", "order", "L2 error",
                              "order", "contact zone", "contact force", "estimated", "effectivity"});
  for (const std::string& problem : problemsOf(table)) {
    const std::vector<AccuracyRow> rows = series(table, problem, "tolerance_1e-10");
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const AccuracyRow& row = rows[i];
      const auto orderOf = [&](double AccuracyRow::*error) {
        return i == 0 ? std::string() : order(rows[i - 1].*error, row.*error);
      };
      text += line({problem, std::to_string(row.elements), std::to_string(std::llround(row.unknowns)),
                    number(row.energyError), orderOf(&AccuracyRow::energyError), number(row.l2Error),
                    orderOf(&AccuracyRow::l2Error), number(row.zoneError), number(row.forceError),
                    number(row.estimatedDiscretisation), number(row.effectivity())});
    }
  }
  return text;
}

std::string variantsReport(const AccuracyTable& table) {
  std::string text = heading({"problem", "elements a side", "variant", "tolerance", "products with F",
                              "on all meshes", "ms", "times the front's", "on the front", "energy error",
                              "of which iteration", "digits", "digits of efficacy", "unknowns a second"});
  for (const AccuracyRow& row : table.rows()) {
    if (row.elements != finestOf(table, row.problem) || isLadder(row))
      continue;
    text += line({row.problem, std::to_string(row.elements), row.variant, row.tolerance, number(row.products),
                  number(row.allProducts), number(1e3 * row.seconds), number(table.distanceToFront(row)),
                  row.isOnFront ? "yes" : "", number(row.energyError), number(row.algebraicError),
                  number(row.digitsOfAccuracy()), number(row.digitsOfEfficacy()),
                  number(row.unknowns / row.seconds)});
  }
  return text;
}

std::string frontReport(const AccuracyTable& table) {
  std::string text = heading({"problem", "elements a side", "default: ms", "times the front's",
                              "on the front", "fastest with that error", "ms"});
  for (const std::string& problem : problemsOf(table))
    for (const AccuracyRow& row : series(table, problem, "default")) {
      const AccuracyRow& fastest = table.fastestLike(row);
      text += line({problem, std::to_string(row.elements), number(1e3 * row.seconds),
                    number(row.seconds / fastest.seconds), row.isOnFront ? "yes" : "", fastest.variant,
                    number(1e3 * fastest.seconds)});
    }
  return text;
}

std::string balanceReport(const AccuracyTable& table) {
  std::string text = heading({"problem", "elements a side", "products at 1e-6", "balanced", "saved",
                              "error over that at 1e-6", "ms at 1e-6", "balanced ms", "saved"});
  for (const std::string& problem : problemsOf(table))
    for (const AccuracyRow& fixed : series(table, problem, "default"))
      if (const AccuracyRow* balanced = table.find(problem, "balanced", fixed.elements); balanced != nullptr)
        text += line({problem, std::to_string(fixed.elements), number(fixed.products),
                      number(balanced->products), percent(1 - balanced->products / fixed.products),
                      number(balanced->energyError / fixed.energyError), number(1e3 * fixed.seconds),
                      number(1e3 * balanced->seconds), percent(1 - balanced->seconds / fixed.seconds)});
  return text;
}

std::string nestedReport(const AccuracyTable& table) {
  std::string text = heading({"problem", "elements a side", "products, balanced", "nested", "saved",
                              "iteration's ms, balanced", "nested", "saved", "ms of this mesh, balanced",
                              "nested", "saved"});
  for (const std::string& problem : problemsOf(table))
    for (const AccuracyRow& balanced : series(table, problem, "balanced")) {
      const AccuracyRow* nested = table.find(problem, "nested", balanced.elements);
      if (nested == nullptr || nested->allProducts == nested->products)
        continue; // there is no coarser mesh to start from
      text += line({problem, std::to_string(balanced.elements), number(balanced.products),
                    number(nested->products), percent(1 - nested->products / balanced.products),
                    number(1e3 * balanced.solveSeconds), number(1e3 * nested->solveSeconds),
                    percent(1 - nested->solveSeconds / balanced.solveSeconds),
                    number(1e3 * balanced.finestSeconds), number(1e3 * nested->finestSeconds),
                    percent(1 - nested->finestSeconds / balanced.finestSeconds)});
    }
  return text;
}

std::string digitsReport(const AccuracyTable& table) {
  std::string text = heading({"problem", "elements a side", "preconditioner", "tolerance", "products with F",
                              "algebraic error", "its estimate", "energy error"});
  for (const AccuracyRow& row : table.rows())
    if (isLadder(row))
      text += line({row.problem, std::to_string(row.elements),
                    row.variant.substr(std::char_traits<char>::length(ladderName)), row.tolerance,
                    number(row.products), number(row.algebraicError), number(row.estimatedAlgebraic),
                    number(row.energyError)});
  return text;
}

} // namespace epafi::drivers
