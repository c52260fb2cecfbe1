#include "AccuracyPeers.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::drivers {
namespace {

constexpr const char* advice = "it is no table of drivers/compare/peers: remove it or run peers anew";

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

std::vector<Row> peerRows(const std::filesystem::path& directory, const AccuracyProblem& problem,
                          const AccuracyReference& reference) {
  std::vector<Row> rows;
  if (problem.order() != 1)
    return rows;
  for (const std::filesystem::path& file : tablesIn(directory))
    for (const Row& peer :
         readCsv(file, {"problem", "unknowns", "solver", "total_seconds", "energy_error", "size", "status"},
                 advice)) {
      if (peer.text("problem") != problem.name || !peer.text("solver").starts_with("snesvi") ||
          peer.text("status") != "ok")
        continue;
      const auto number = [&](const char* column) { return numberIn(peer, column, file, advice); };
      for (int level = 0; level < problem.meshes; ++level) {
        const TightSolution& tight = reference.tight(level);
        if (elementsOfSide(tight.run.scene) != static_cast<int>(number("size")))
          continue;
        const double iteration = std::sqrt(number("energy_error")), seconds = number("total_seconds");
        const double mesh = tight.error.energy / reference.norms().energy;
        rows.push_back({{"problem", problem.name},
                        {"variant", peer.text("solver")},
                        {"order", 1},
                        {"elements", number("size")},
                        {"tolerance", peer.text("tolerance")},
                        {"status", "Converged"},
                        {"unknowns", number("unknowns")},
                        {"seconds", seconds},
                        {"finest_seconds", seconds},
                        {"solve_seconds", seconds},
                        {"algebraic_error", iteration},
                        {"discretisation_error", mesh},
                        {"energy_error", std::hypot(iteration, mesh)},
                        {"repeats", number("repeats")}});
        addDigits(rows.back());
      }
    }
  return rows;
}

} // namespace epafi::drivers
