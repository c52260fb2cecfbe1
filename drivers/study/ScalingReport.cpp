#include "ScalingReport.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace epafi::drivers {
namespace {

constexpr double milli = 1e-3, micro = 1e-6, giga = 1e9, mega = 1e6;

std::string heading(const std::string& title, const std::string& names) {
  return "\n" + title + "\n\n" + markdownHeading(names);
}

/// Numbers of a row in one unit; 0: whole numbers.
std::vector<std::string> numbers(const Row& row, const std::vector<std::string>& columns, double unit) {
  std::vector<std::string> entries;
  for (const std::string& column : columns)
    entries.push_back(unit == 0 ? count(row.number(column)) : inUnits(row.number(column), unit));
  return entries;
}

/// Parts of a line one after the other.
std::string line(const std::vector<std::vector<std::string>>& parts) {
  std::vector<std::string> entries;
  for (const auto& part : parts)
    entries.insert(entries.end(), part.begin(), part.end());
  return markdownLine(entries);
}

bool isDefault(const Row& row) {
  return scalingRun("", 0, 0).isLike(row, {"operator", "preconditioner", "precision"});
}

std::string growthLine(const Row& row) {
  // Matrices, factors, dense blocks and vectors.
  const double needed =
      row.number("factor_bytes") + row.number("preconditioner_bytes") + row.number("problem_bytes");
  const double held = row.number("peak_bytes") - row.number("base_bytes");
  return line({{row.text("problem")},
               numbers(row,
                       {"H_inverse", "H_over_h", "unknowns", "multipliers", "coarse_unknowns",
                        "hessian_multiplications"},
                       0),
               numbers(row, {"assembly_seconds", "setup_seconds", "solve_seconds", "total_seconds"}, milli),
               {inUnits(held, mega), inUnits(needed, mega), inUnits(held / needed)}});
}

std::string growthReport(const Table& table, const ScalingSizes& sizes) {
  std::string text =
      heading("Growing number and size of subdomains, one rank, F shared, Dirichlet preconditioner:",
              "problem | 1/H | H/h | unknowns | multipliers | coarse | products with F | assembly ms | setup "
              "ms | solve "
              "ms | total ms | peak MB | matrices, factors, vectors MB | ratio");
  const auto addRows = [&](const char* problem, const std::function<bool(const Row&)>& isWanted) {
    for (const Row& row : table.rows)
      if (row.text("problem") == problem && row.number("ranks") == 1 && isDefault(row) && isWanted(row))
        text += growthLine(row);
  };
  const std::vector<int>& fixed = sizes.fixedElements;
  for (const char* problem : {"coercive", "semicoercive"}) {
    for (const int elements : fixed)
      addRows(problem, [&](const Row& row) { return row.number("H_over_h") == elements; });
    addRows(problem, [&](const Row& row) {
      return row.number("H_inverse") == sizes.fixedSubdomains &&
             std::find(fixed.begin(), fixed.end(), static_cast<int>(row.number("H_over_h"))) == fixed.end();
    });
  }
  return text;
}

std::string combinationReport(const Table& table, const ScalingSizes& sizes) {
  std::string text = heading(
      "Forms of F and preconditioners, coercive, 1/H = " + std::to_string(sizes.fixedSubdomains) +
          ", one rank:",
      "H/h | F | preconditioner | products with F | setup ms | dense blocks ms | solve ms | total ms | one "
      "product ms | one preconditioning ms | F reads MB | GB/s | of the triad | pays off after");
  for (const std::vector<int>& elements : {sizes.allCombinations, sizes.someCombinations})
    for (const int ratio : elements)
      for (const char* dualOperator : {"implicit", "explicit", "shared"})
        for (const Row& row : table.rows) {
          Row wanted = scalingRun("coercive", sizes.fixedSubdomains, ratio);
          wanted["operator"] = dualOperator;
          if (!wanted.isLike(row, {"problem", "H_inverse", "H_over_h", "ranks", "operator"}))
            continue;
          const std::string& preconditioner = row.text("preconditioner");
          const double rate = row.number("apply_bytes") / row.number("apply_seconds");
          text += line(
              {{count(ratio), dualOperator,
                preconditioner == "none" ? preconditioner : preconditioner + ", " + row.text("precision"),
                count(row.number("hessian_multiplications"))},
               numbers(row,
                       {"setup_seconds", "explicit_setup_seconds", "solve_seconds", "total_seconds",
                        "apply_seconds", "preconditioner_seconds"},
                       milli),
               {inUnits(row.number("apply_bytes"), mega), inUnits(rate, giga),
                inUnits(rate / row.number("stream_bytes_per_second")),
                inUnits(row.number("payoff_products"))}});
        }
  return text;
}

std::string ranksReport(const Table& table, const ScalingSizes& sizes) {
  std::string text =
      heading("Ranks, coercive, H/h = " + std::to_string(sizes.ranksElements) + ":",
              "series | F | ranks | 1/H | products with F | assembly ms | setup ms | solve ms | total ms "
              "| efficiency | messages a product | bytes sent a product | sums a step | bytes summed a "
              "product");
  for (const bool isStrong : {true, false})
    for (const char* dualOperator : {"shared", "explicit"})
      for (const Row& row : table.rows) {
        const auto subdomainsOn = [&](double ranks) {
          return isStrong ? sizes.strongSubdomains : sizes.weakOn(ranks);
        };
        const double ranks = row.number("ranks");
        Row wanted =
            scalingRun("coercive", subdomainsOn(ranks), sizes.ranksElements, static_cast<int>(ranks));
        wanted["operator"] = dualOperator;
        if (!wanted.isLike(row, scalingSettings))
          continue;
        Row alone = wanted;
        alone["ranks"] = 1;
        alone["H_inverse"] = subdomainsOn(1);
        const Row* base = table.find(alone, scalingSettings);
        const double work = std::pow(row.number("H_inverse") / alone.number("H_inverse"), 2) / ranks;
        text += line(
            {{isStrong ? "strong" : "weak", dualOperator},
             numbers(row, {"ranks", "H_inverse", "hessian_multiplications"}, 0),
             numbers(row, {"assembly_seconds", "setup_seconds", "solve_seconds", "total_seconds"}, milli),
             {base == nullptr ? "–"
                              : inUnits(base->number("total_seconds") * work / row.number("total_seconds"))},
             numbers(row, {"messages_per_apply", "bytes_sent_per_apply"}, 0),
             numbers(row, {"reductions_per_step"}, 1),
             numbers(row, {"reduction_bytes_per_apply"}, 0)});
      }
  return text;
}

/// What the methods send, by the number of ranks.
std::string methodsReport(const Table& table, const ScalingSizes& sizes) {
  std::string text =
      heading("Methods on ranks:",
              "problem | ranks | 1/H | subdomains a cluster | products with F | total ms | messages a "
              "product | bytes sent a product | sums a step | bytes summed a step | gatherings a step | sums "
              "in teams a step");
  for (const char* problem : {"coercive", "blocks"})
    for (const Row& row : table.rows) {
      const bool isBlocks = problem == std::string("blocks");
      if (row.text("problem") != problem || row.text("operator") != (isBlocks ? "implicit" : "shared") ||
          row.number("H_inverse") != (isBlocks ? sizes.blocks : sizes.strongSubdomains) ||
          row.number("H_over_h") != (isBlocks ? sizes.blocksElements : sizes.ranksElements) ||
          row.text("preconditioner") != "dirichlet" || row.text("precision") != "double")
        continue;
      text += line({{problem},
                    numbers(row, {"ranks", "H_inverse"}, 0),
                    {row.number("cluster") == 0 ? "all of a body" : count(row.number("cluster"))},
                    numbers(row, {"hessian_multiplications"}, 0),
                    numbers(row, {"total_seconds"}, milli),
                    numbers(row,
                            {"messages_per_apply", "bytes_sent_per_apply", "reductions_per_step",
                             "reduction_bytes_per_step", "gatherings_per_step", "team_reductions_per_step"},
                            0)});
    }
  return text;
}

} // namespace

std::string scalingReport(const Table& table, const ScalingSizes& sizes) {
  return growthReport(table, sizes) + combinationReport(table, sizes) + ranksReport(table, sizes) +
         methodsReport(table, sizes);
}

std::string blockReport(const Table& products, double streamRate) {
  std::string text =
      heading("Dense symmetric products y = A x beside the triad (" + inUnits(streamRate, giga) + " GB/s):",
              "n | kernel | µs a vector | GB/s of the matrix");
  for (const Row& row : products.rows)
    text += line({{count(row.number("n")), row.text("kernel"), inUnits(row.number("seconds"), micro),
                   inUnits(row.number("bytes_per_second"), giga)}});
  return text;
}

std::string costReport(const Table& times) {
  std::string text =
      heading("The cost model: measured / expected",
              "H/h | shared | n_Δ | implicit ms | explicit ms | dense blocks ms | pays off after | factor "
              "entries 1e9/s | block 1e9/s | inverse 1e9/s");
  for (const Row& row : times.rows) {
    std::vector<std::string> both;
    for (const std::string cost :
         {"implicit_seconds", "explicit_seconds", "explicit_setup_seconds", "payoff_products"}) {
      const double unit = cost.ends_with("seconds") ? milli : 1;
      both.push_back(inUnits(row.number(cost), unit) + " / " + inUnits(row.number("expected_" + cost), unit));
    }
    text += line({{count(row.number("H_over_h")), row.number("shared") == 1 ? "yes" : "no",
                   count(row.number("boundary"))},
                  both,
                  numbers(row, {"factor_rate", "block_rate", "inverse_rate"}, giga)});
  }
  return text;
}

std::string predictionReport(const Table& steps) {
  const Network network;
  constexpr double subdomainsARank = 64;
  std::string text = heading(
      "Predicted: one iteration with " + count(subdomainsARank) + " subdomains a rank, latency " +
          inUnits(network.latency, micro) + " µs, " + inUnits(network.bandwidth, giga) + " GB/s a rank:",
      "problem | method | ranks | ranks a cluster | coarse unknowns | local µs | neighbours µs | scalar "
      "products µs | coarse "
      "sum µs "
      "| coarse solve µs | iteration µs | efficiency | coarse share | coarse MB a rank");
  for (const Row& step : steps.rows)
    if (step.number("subdomains_a_rank") == subdomainsARank)
      text += line({{step.text("problem"), step.text("method")},
                    numbers(step, {"ranks", "cluster_ranks", "coarse_unknowns"}, 0),
                    numbers(step,
                            {"local_seconds", "neighbour_seconds", "reduction_seconds", "coarse_sum_seconds",
                             "coarse_solve_seconds", "total_seconds"},
                            micro),
                    numbers(step, {"efficiency", "coarse_share"}, 1),
                    numbers(step, {"bytes_a_rank"}, mega)});
  return text;
}

} // namespace epafi::drivers
