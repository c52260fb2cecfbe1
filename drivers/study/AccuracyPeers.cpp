#include "AccuracyPeers.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace epafi::drivers {
namespace {

using Entries = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream text(line);
  for (std::string word; std::getline(text, word, ',');)
    words.push_back(word);
  return words;
}

/// Lines as {column, entry}; what follows a quoted entry, which only failures have, does not count.
std::vector<Entries> readTable(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> columns = split(line);
  for (const char* needed :
       {"problem", "unknowns", "solver", "total_seconds", "energy_error", "size", "status"})
    if (std::find(columns.begin(), columns.end(), needed) == columns.end())
      throw InputError("file " + file.string() + " is no table of drivers/compare/peers: it has no column " +
                       needed + "; remove it or run peers anew");
  std::vector<Entries> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> words = split(line);
    Entries row;
    for (std::size_t i = 0; i < std::min(words.size(), columns.size()); ++i)
      row[columns[i]] = words[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const Entries& row, const char* column, const std::filesystem::path& file) {
  std::istringstream text(row.at(column));
  double value = 0;
  if (!(text >> value))
    throw InputError("file " + file.string() + ", column " + column + ": \"" + row.at(column) +
                     "\" is no number; run peers anew");
  return value;
}

std::vector<std::filesystem::path> tablesIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files{directory / "peers.csv"};
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(directory / "peers", none))
    files.push_back(entry.path() / "peers.csv");
  std::erase_if(files, [&none](const auto& file) { return !std::filesystem::is_regular_file(file, none); });
  std::sort(files.begin(), files.end());
  return files;
}

} // namespace

std::vector<AccuracyRow> peerRows(const std::filesystem::path& directory, const AccuracyProblem& problem,
                                  const AccuracyReference& reference) {
  std::vector<AccuracyRow> rows;
  for (const std::filesystem::path& file : tablesIn(directory))
    for (const Entries& entries : readTable(file)) {
      const std::string& solver = entries.at("solver");
      if (entries.at("problem") != problem.name || solver.rfind("snesvi", 0) != 0 ||
          entries.at("status") != "ok")
        continue;
      for (int level = 0; level < problem.meshes; ++level) {
        const TightSolution& tight = reference.tight(level);
        const int elements = elementsOfSide(tight.run.scene);
        if (elements != static_cast<int>(number(entries, "size", file)))
          continue;
        AccuracyRow row;
        row.problem = problem.name;
        row.variant = solver;
        row.elements = elements;
        row.tolerance = entries.at("tolerance");
        row.unknowns = number(entries, "unknowns", file);
        row.seconds = row.finestSeconds = row.solveSeconds = number(entries, "total_seconds", file);
        row.algebraicError = std::sqrt(number(entries, "energy_error", file));
        row.discretisationError = tight.error.energy / reference.norms().energy;
        row.energyError = std::hypot(row.algebraicError, row.discretisationError);
        row.repeats = static_cast<int>(number(entries, "repeats", file));
        rows.push_back(row);
      }
    }
  return rows;
}

} // namespace epafi::drivers
