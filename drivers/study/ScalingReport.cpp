#include "ScalingReport.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace epafi::drivers {
namespace {

constexpr double milli = 1e-3, micro = 1e-6, giga = 1e9, mega = 1e6;

/// Three digits, in the given unit; a dash where nothing was measured.
std::string number(double value, double unit = 1) {
  if (std::isnan(value))
    return "–";
  if (std::isinf(value))
    return "∞";
  std::ostringstream text;
  const double scaled = value / unit;
  const int digits =
      scaled == 0 ? 0 : std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(scaled)))), 0, 6);
  text << std::fixed << std::setprecision(digits) << scaled;
  return text.str();
}

/// All its digits.
std::string count(double value) {
  return std::isnan(value) ? "–" : std::to_string(std::llround(value));
}

std::string line(const std::vector<std::string>& entries) {
  std::string text = "|";
  for (const std::string& entry : entries)
    text += " " + entry + " |";
  return text + "\n";
}

std::string heading(const std::string& title, const std::vector<std::string>& names) {
  return "\n" + title + "\n\n" + line(names) + line(std::vector<std::string>(names.size(), "---"));
}

std::string nameOf(const ScalingRow& row) {
  return row.preconditioner == "none" ? "none" : row.preconditioner + ", " + row.precision;
}

bool isDefault(const ScalingRow& row) {
  return row.dualOperator == "shared" && row.preconditioner == "dirichlet" && row.precision == "double";
}

/// Rows with the same form of F together.
std::vector<ScalingRow> inOrder(std::vector<ScalingRow> rows) {
  const auto rank = [](const ScalingRow& row) {
    return row.dualOperator == "implicit" ? 0 : row.dualOperator == "explicit" ? 1 : 2;
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const ScalingRow& a, const ScalingRow& b) { return rank(a) < rank(b); });
  return rows;
}

/// Share of the triad's speed at which a product with F reads its factors or blocks.
double fractionOfStream(const ScalingRow& row) {
  return row.applyBytes / row.applySeconds / row.streamRate;
}

/// Matrices, factors, dense blocks and vectors.
double neededBytes(const ScalingRow& row) {
  return row.factorBytes + row.preconditionerBytes + row.problemBytes;
}

std::string growthLine(const ScalingRow& row) {
  return line({row.problem, count(row.subdomainsPerSide), count(row.elementsPerSide), count(row.unknowns),
               count(row.multipliers), count(row.coarseUnknowns), count(row.hessianMultiplications),
               number(row.assembly, milli), number(row.setup, milli), number(row.solve, milli),
               number(row.total, milli), number(row.peakBytes - row.baseBytes, mega),
               number(neededBytes(row), mega),
               number((row.peakBytes - row.baseBytes) / neededBytes(row), 1)});
}

} // namespace

std::string growthReport(const ScalingTable& table, const ScalingSizes& sizes) {
  std::string text =
      heading("Growing number and size of subdomains, one rank, F shared, Dirichlet preconditioner:",
              {"problem", "1/H", "H/h", "unknowns", "multipliers", "coarse", "products with F", "assembly ms",
               "setup ms", "solve ms", "total ms", "peak MB", "matrices, factors, vectors MB", "ratio"});
  for (const char* problem : {"coercive", "semicoercive"}) {
    for (const int elements : sizes.fixedElements)
      for (const ScalingRow& row : table.rows())
        if (row.problem == problem && row.ranks == 1 && row.elementsPerSide == elements && isDefault(row))
          text += growthLine(row);
    for (const ScalingRow& row : table.rows())
      if (row.problem == problem && row.ranks == 1 && row.subdomainsPerSide == sizes.fixedSubdomains &&
          std::find(sizes.fixedElements.begin(), sizes.fixedElements.end(),
                    static_cast<int>(row.elementsPerSide)) == sizes.fixedElements.end() &&
          isDefault(row))
        text += growthLine(row);
  }
  return text;
}

std::string combinationReport(const ScalingTable& table, const ScalingSizes& sizes) {
  std::string text = heading(
      "Forms of F and preconditioners, coercive, 1/H = " + std::to_string(sizes.fixedSubdomains) +
          ", one rank:",
      {"H/h", "F", "preconditioner", "products with F", "setup ms", "dense blocks ms", "solve ms", "total ms",
       "one product ms", "one preconditioning ms", "F reads MB", "GB/s", "of the triad", "pays off after"});
  for (const std::vector<int>& elements : {sizes.allCombinations, sizes.someCombinations})
    for (const int ratio : elements)
      for (const ScalingRow& row : inOrder(table.rows()))
        if (row.problem == "coercive" && row.ranks == 1 && row.subdomainsPerSide == sizes.fixedSubdomains &&
            row.elementsPerSide == ratio)
          text += line({count(ratio), row.dualOperator, nameOf(row), count(row.hessianMultiplications),
                        number(row.setup, milli), number(row.explicitSetup, milli), number(row.solve, milli),
                        number(row.total, milli), number(row.applySeconds, milli),
                        number(row.preconditionerSeconds, milli), number(row.applyBytes, mega),
                        number(row.applyBytes / row.applySeconds, giga), number(fractionOfStream(row)),
                        number(row.payoffProducts)});
  return text;
}

std::string ranksReport(const ScalingTable& table, const ScalingSizes& sizes) {
  std::string text = heading("Ranks, coercive, H/h = " + std::to_string(sizes.ranksElements) + ":",
                             {"series", "F", "ranks", "1/H", "products with F", "assembly ms", "setup ms",
                              "solve ms", "total ms", "efficiency", "messages a product",
                              "bytes sent a product", "sums a step", "bytes summed a product"});
  for (const bool isStrong : {true, false})
    for (const char* dualOperator : {"shared", "explicit"})
      for (const ScalingRow& row : table.rows()) {
        const int wanted = isStrong ? sizes.strongSubdomains : sizes.weakOn(row.ranks);
        if (row.problem != "coercive" || row.subdomainsPerSide != wanted ||
            row.dualOperator != dualOperator || row.elementsPerSide != sizes.ranksElements ||
            row.preconditioner != "dirichlet" || row.precision != "double")
          continue;
        ScalingRow alone = row;
        alone.ranks = 1;
        alone.subdomainsPerSide = isStrong ? sizes.strongSubdomains : sizes.weakOn(1);
        const ScalingRow* base = table.find(alone);
        const double work = row.numSubdomains() / alone.numSubdomains() / row.ranks;
        text += line(
            {isStrong ? "strong" : "weak", row.dualOperator, count(row.ranks), count(row.subdomainsPerSide),
             count(row.hessianMultiplications), number(row.assembly, milli), number(row.setup, milli),
             number(row.solve, milli), number(row.total, milli),
             base == nullptr ? "–" : number(base->total * work / row.total), count(row.messagesPerApply),
             count(row.bytesSentPerApply), number(row.reductionsPerStep), count(row.reductionBytesPerApply)});
      }
  return text;
}

std::string blockReport(const std::vector<BlockProduct>& products, double streamRate) {
  std::string text =
      heading("Dense symmetric products y = A x beside the triad (" + number(streamRate, giga) + " GB/s):",
              {"n", "kernel", "µs a vector", "GB/s of the matrix"});
  for (const BlockProduct& product : products)
    text += line({count(product.size), product.kernel, number(product.seconds, micro),
                  number(product.bytesPerSecond, giga)});
  return text;
}

std::string blocksCsv(const std::vector<BlockProduct>& products, double streamRate) {
  std::ostringstream csv;
  csv << "n,kernel,seconds,bytes_per_second,stream_bytes_per_second\n";
  for (const BlockProduct& product : products)
    csv << product.size << ',' << product.kernel << ',' << product.seconds << ',' << product.bytesPerSecond
        << ',' << streamRate << '\n';
  return csv.str();
}

std::string costReport(const std::vector<DualCostTimes>& times) {
  std::string text = heading("The cost model: measured / expected",
                             {"H/h", "shared", "n_Δ", "implicit ms", "explicit ms", "dense blocks ms",
                              "pays off after", "factor entries 1e9/s", "block 1e9/s", "inverse 1e9/s"});
  const auto both = [](double measured, double expected, double unit) {
    return number(measured, unit) + " / " + number(expected, unit);
  };
  for (const DualCostTimes& row : times)
    text += line({count(row.elementsPerSide), row.isShared ? "yes" : "no", count(row.boundary),
                  both(row.measured.implicitProduct, row.expected.implicitProduct, milli),
                  both(row.measured.explicitProduct, row.expected.explicitProduct, milli),
                  both(row.measured.explicitSetup, row.expected.explicitSetup, milli),
                  both(DualCostTimes::payoff(row.measured), DualCostTimes::payoff(row.expected), 1),
                  number(row.factorRate, giga), number(row.blockRate, giga), number(row.inverseRate, giga)});
  return text;
}

std::string predictionReport(const std::vector<PredictedStep>& steps, const ScalingRow& like) {
  const Network network;
  std::string text = heading(
      "Predicted: one iteration of the coercive problem, H/h = " + count(like.elementsPerSide) +
          ", latency " + number(network.latency, micro) + " µs, " + number(network.bandwidth, giga) +
          " GB/s a rank:",
      {"subdomains a rank", "ranks", "coarse unknowns", "local µs", "neighbours µs", "scalar products µs",
       "coarse sum µs", "coarse solve µs", "iteration µs", "efficiency", "coarse share", "coarse factor MB"});
  for (const PredictedStep& step : steps)
    text += line({count(step.subdomainsPerRank), count(step.ranks), count(step.coarseUnknowns),
                  number(step.local, micro), number(step.neighbours, micro), number(step.reductions, micro),
                  number(step.coarseSum, micro), number(step.coarseSolve, micro), number(step.total(), micro),
                  number(step.efficiency()), number(step.coarseShare()), number(step.coarseBytes, mega)});
  return text;
}

} // namespace epafi::drivers
