#include "ScalingTable.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

namespace epafi::drivers {
namespace {

/// A column: where its entries stand in a row.
struct Column {
  const char* name;
  double ScalingRow::*number = nullptr;
  std::string ScalingRow::*text = nullptr;
};

constexpr auto numeric(const char* name, double ScalingRow::*number) {
  return Column{name, number, nullptr};
}
constexpr auto textual(const char* name, std::string ScalingRow::*text) {
  return Column{name, nullptr, text};
}

const std::array columns{
    textual("problem", &ScalingRow::problem),
    numeric("H_inverse", &ScalingRow::subdomainsPerSide),
    numeric("H_over_h", &ScalingRow::elementsPerSide),
    numeric("ranks", &ScalingRow::ranks),
    textual("operator", &ScalingRow::dualOperator),
    textual("preconditioner", &ScalingRow::preconditioner),
    numeric("hessian_multiplications", &ScalingRow::hessianMultiplications),
    numeric("assembly_seconds", &ScalingRow::assembly),
    numeric("setup_seconds", &ScalingRow::setup),
    numeric("solve_seconds", &ScalingRow::solve),
    numeric("total_seconds", &ScalingRow::total),
    numeric("peak_bytes", &ScalingRow::peakBytes),
    numeric("apply_seconds", &ScalingRow::applySeconds),
    numeric("apply_bytes", &ScalingRow::applyBytes),
    numeric("stream_bytes_per_second", &ScalingRow::streamRate),
    textual("precision", &ScalingRow::precision),
    numeric("messages_per_apply", &ScalingRow::messagesPerApply),
    numeric("bytes_sent_per_apply", &ScalingRow::bytesSentPerApply),
    numeric("coarse_unknowns", &ScalingRow::coarseUnknowns),
    numeric("reductions_per_step", &ScalingRow::reductionsPerStep),
    numeric("factor_bytes", &ScalingRow::factorBytes),
    numeric("explicit_setup_seconds", &ScalingRow::explicitSetup),
    numeric("payoff_products", &ScalingRow::payoffProducts),
    numeric("energy", &ScalingRow::energy),
    numeric("preconditioner_seconds", &ScalingRow::preconditionerSeconds),
    numeric("preconditioner_bytes", &ScalingRow::preconditionerBytes),
    numeric("problem_bytes", &ScalingRow::problemBytes),
    numeric("base_bytes", &ScalingRow::baseBytes),
    numeric("unknowns", &ScalingRow::unknowns),
    numeric("multipliers", &ScalingRow::multipliers),
    numeric("reduction_bytes_per_apply", &ScalingRow::reductionBytesPerApply),
};

std::string header() {
  std::ostringstream text;
  for (const Column& column : columns)
    text << (&column == columns.data() ? "" : ",") << column.name;
  return text.str();
}

ScalingRow parse(const std::string& line, const std::filesystem::path& file) {
  ScalingRow row;
  std::istringstream entries(line + ',');
  for (const Column& column : columns) {
    std::string entry;
    if (!std::getline(entries, entry, ','))
      throw InputError("a row of " + file.string() + " ends before column " + column.name + ": \"" + line +
                       "\"; move the file away to start anew");
    if (column.text != nullptr) {
      row.*column.text = entry;
      continue;
    }
    try {
      row.*column.number = entry.empty() ? ScalingRow::unknown : std::stod(entry);
    } catch (const std::exception&) {
      throw InputError("column " + std::string(column.name) + " of " + file.string() + " holds '" + entry +
                       "', which is no number; move the file away to start anew");
    }
  }
  return row;
}

} // namespace

bool ScalingRow::isSameRun(const ScalingRow& other) const {
  return problem == other.problem && subdomainsPerSide == other.subdomainsPerSide &&
         elementsPerSide == other.elementsPerSide && ranks == other.ranks &&
         dualOperator == other.dualOperator && preconditioner == other.preconditioner &&
         precision == other.precision;
}

ScalingTable::ScalingTable(const std::filesystem::path& file) {
  std::ifstream input(file);
  std::string line;
  if (!std::getline(input, line))
    return;
  if (line != header())
    throw InputError(file.string() +
                     " has other columns than this study writes; its rows of other numbers of ranks "
                     "cannot be kept: move it away to start anew");
  while (std::getline(input, line))
    rows_.push_back(parse(line, file));
}

void ScalingTable::removeRanks(double ranks) {
  std::erase_if(rows_, [ranks](const ScalingRow& row) { return row.ranks == ranks; });
}

const ScalingRow* ScalingTable::find(const ScalingRow& run) const {
  const auto found =
      std::find_if(rows_.begin(), rows_.end(), [&](const ScalingRow& row) { return row.isSameRun(run); });
  return found == rows_.end() ? nullptr : &*found;
}

std::string ScalingTable::csv() const {
  std::vector<ScalingRow> sorted = rows_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const ScalingRow& a, const ScalingRow& b) { return a.ranks < b.ranks; });
  std::ostringstream text;
  text.precision(10);
  text << header() << '\n';
  for (const ScalingRow& row : sorted)
    for (const Column& column : columns) {
      text << (&column == columns.data() ? "" : ",");
      if (column.text != nullptr)
        text << row.*column.text;
      else if (!std::isnan(row.*column.number))
        text << row.*column.number;
      if (&column == &columns.back())
        text << '\n';
    }
  return text.str();
}

} // namespace epafi::drivers
