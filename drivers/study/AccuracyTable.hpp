#pragma once

/// accuracy.csv: one row a run, errors and costs.

#include <limits>
#include <string>
#include <vector>

namespace epafi::drivers {

/// What ran, how wrong its result is, and what it cost. Errors are relative: in the energy norm to ‖u‖_K of the reference, in
/// L2 to ‖u‖, contact zone and force to those of the reference. NaN is what was not measured: an empty entry.
struct AccuracyRow {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string problem, variant;
  int elements = 0;                 ///< along a side of the first body
  std::string tolerance;            ///< a number, or "balanced"
  std::string status = "Converged"; ///< of the iteration on the finest mesh
  double unknowns = unknown;        ///< primal dimension
  double seconds = unknown;         ///< from scene to solution, of all meshes that were solved on
  double products = unknown;        ///< with F, on the finest of them
  double energyError = unknown;     ///< of both parts: (algebraic² + discretisation²)^½
  double algebraicError = unknown;
  double estimatedError = unknown; ///< what the run itself says of energyError
  bool isOnFront = false;
  double discretisationError = unknown;
  double l2Error = unknown, zoneError = unknown, forceError = unknown;
  double estimatedDiscretisation = unknown, estimatedAlgebraic = unknown;
  double allProducts = unknown;   ///< on all meshes, those on coarser ones by their share of unknowns
  double finestSeconds = unknown; ///< on the finest mesh alone
  double solveSeconds = unknown;  ///< of its iteration alone
  int repeats = 1;                ///< of which times are medians

  /// Estimated over true discretisation error.
  [[nodiscard]] double effectivity() const { return estimatedDiscretisation / discretisationError; }
  // Chang, Fabien, Knepley, Mills, *Comparative study of finite element methods using the Time-Accuracy-Size (TAS) spectrum
  // analysis*, SIAM J. Sci. Comput. 40 (2018).
  [[nodiscard]] double digitsOfAccuracy() const;
  [[nodiscard]] double digitsOfEfficacy() const; ///< −log₁₀(error · seconds)
  [[nodiscard]] double digitsOfSize() const;
};

class AccuracyTable {
public:
  void add(const AccuracyRow& row) { rows_.push_back(row); }
  [[nodiscard]] const std::vector<AccuracyRow>& rows() const { return rows_; }
  /// The row of a run, or null.
  [[nodiscard]] const AccuracyRow* find(const std::string& problem, const std::string& variant,
                                        int elements) const;
  /// Marks the rows of each problem beside which no other is both faster and no less accurate;
  /// none without a time.
  void markFront();
  /// The fastest row of a row's problem with an error at most 2 % larger, itself perhaps. Precondition: the row is one of these.
  [[nodiscard]] const AccuracyRow& fastestLike(const AccuracyRow& row) const;
  /// A row's seconds over those of the fastest one like it.
  [[nodiscard]] double distanceToFront(const AccuracyRow& row) const;
  /// The text of accuracy.csv.
  [[nodiscard]] std::string csv() const;

private:
  std::vector<AccuracyRow> rows_;
};

/// Errors this much apart are taken as equal.
constexpr double equalErrors = 1.02;

} // namespace epafi::drivers
