#pragma once

/// scaling.csv: one row a run, kept from one call of the study to the next.

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace epafi::drivers {

/// What runs, and what it took. Times in seconds, the largest over the ranks; bytes of all ranks together unless said
/// otherwise. NaN is what was not measured: an empty entry.
struct ScalingRow {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string problem = "coercive";
  double subdomainsPerSide = 0; ///< 1/H
  double elementsPerSide = 0;   ///< H/h
  double ranks = 1;
  std::string dualOperator = "shared";      ///< implicit, explicit, shared
  std::string preconditioner = "dirichlet"; ///< none, lumped, dirichlet
  std::string precision = "double";         ///< of the preconditioner

  double hessianMultiplications = unknown;
  double assembly = unknown, setup = unknown, solve = unknown, total = unknown; ///< total: recovery of u too
  double peakBytes = unknown;
  double applySeconds = unknown; ///< one product with F
  double applyBytes = unknown;   ///< that it reads of factors or blocks
  double streamRate = unknown;   ///< bytes a second of the triad
  double messagesPerApply = unknown,
         bytesSentPerApply = unknown; ///< of the rank with most, to its neighbours
  double coarseUnknowns = unknown;
  double reductionsPerStep = unknown;
  double factorBytes = unknown;   ///< and dense blocks of F
  double explicitSetup = unknown; ///< the dense blocks alone
  double payoffProducts = unknown;
  double energy = unknown;
  double preconditionerSeconds = unknown; ///< one application
  double preconditionerBytes = unknown;
  double problemBytes = unknown;           ///< different subdomain matrices, and vectors
  double baseBytes = unknown;              ///< held before the run: program and libraries
  double unknowns = unknown;               ///< primal dimension
  double multipliers = unknown;            ///< dual dimension
  double reductionBytesPerApply = unknown; ///< of one rank

  [[nodiscard]] double numSubdomains() const { return 2 * subdomainsPerSide * subdomainsPerSide; }
  /// Whether it is the same run, with other measurements.
  [[nodiscard]] bool isSameRun(const ScalingRow& other) const;
};

class ScalingTable {
public:
  ScalingTable() = default;
  /// Reads what an earlier call of the study wrote; empty if there is no such file.
  /// \throws InputError if the file has other columns or an entry that is no number.
  explicit ScalingTable(const std::filesystem::path& file);

  /// Rows of other numbers of ranks stay.
  void removeRanks(double ranks);
  void add(const ScalingRow& row) { rows_.push_back(row); }
  [[nodiscard]] const std::vector<ScalingRow>& rows() const { return rows_; }
  /// The row of the same run, or null.
  [[nodiscard]] const ScalingRow* find(const ScalingRow& run) const;
  /// The text of scaling.csv, rows of few ranks first.
  [[nodiscard]] std::string csv() const;

private:
  std::vector<ScalingRow> rows_;
};

} // namespace epafi::drivers
