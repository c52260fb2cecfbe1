#pragma once

/// One row of qp.csv: a benchmark, a size, a method, a preconditioner and a start.

#include "epafi/base/Types.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

struct QpCase {
  std::string problem;                    ///< journal_bearing, obstacle or torsion
  int size = 0;                           ///< unknowns a side
  std::string expansion = "projected CG"; ///< as MPRGP's parameter names it
  /// none; multigrid, of the whole matrix; face_multigrid, of the matrix restricted to the face of the start
  std::string preconditioner = "none";
  /// zero; unconstrained, the solution without bounds, projected; nested, the solution on a mesh of twice the
  /// width, itself started so, from about 20 × 20 on; interpolated
  std::string start = "zero";
  double proportioningConstant = 1; ///< Γ
  double expansionStep = 1.9;       ///< ᾱ‖A‖
};

struct QpResult {
  qp::SolveReport report;
  int normMultiplications = 0; ///< products of the estimate of ‖A‖
  /// Products that the start took, norm estimates included, in products of this size: those of a coarser mesh
  /// count as its share of the unknowns.
  double startMultiplications = 0;
  double seconds = 0;      ///< of all: start, norm, preconditioner, iteration
  double startSeconds = 0; ///< of the start alone
};

/// The rows of cases/qp.cases.
std::vector<QpCase> qpCases(bool quick);

/// \throws InputError if the problem is unknown. Collective.
QpResult solveCase(const QpCase& row, const RCP<const Comm>& comm);

/// The method in one word, for the table: "projected_cg", "fixed_step", …
std::string methodName(const QpCase& row);

} // namespace epafi::drivers
