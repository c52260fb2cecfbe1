#pragma once

/// Rows of contact and ties that no displacement satisfies, whatever the stiffness of the bodies: supports,
/// obstacles and ties prescribe what they forbid.

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ProblemData.hpp"

#include <string>
#include <vector>

namespace epafi::fetidp {

/// Names rows by their numbers; who knows what they are of says so.
class ContradictionError : public SolvabilityError {
public:
  /// \param rows  numbers of those that take part, of contact and ties; the one that weighs most is the first
  /// \param misfit   by how much: "they overlap by 0.01"
  /// \param names    of them, for the sentence, which says each once, and a few
  /// \param place    of the first; empty: unknown
  ContradictionError(std::vector<GlobalOrdinal> rows, std::string misfit, std::vector<std::string> names,
                     const std::string& place = "");
  [[nodiscard]] const std::vector<GlobalOrdinal>& rows() const { return rows_; }
  [[nodiscard]] const std::string& misfit() const { return misfit_; }

private:
  std::vector<GlobalOrdinal> rows_;
  std::string misfit_;
};

/// Throws ContradictionError, the same on all ranks, if B_I u ≤ c_I, B_T u = c_T, B_E u = 0 contradict each
/// other, or can only be met by displacements out of all proportion to what overlaps. Nothing is done where u
/// = 0 satisfies them, which is most often; else min ½‖Bᵀd‖² + cᵀd, d_I ≥ 0, by MPRGP: bounded exactly if
/// there is such a u, and then u = −Bᵀd is one. Products with sparse rows alone. Collective.
void requireFeasibleGaps(const decomposition::DecomposedProblem& problem,
                         const decomposition::ProblemData& data);

/// Throws ContradictionError likewise if d proves that no u satisfies B_I u ≤ c_I, B_E u = 0: d_I ≥ 0, Bᵀd =
/// 0 and cᵀd < 0 (Farkas), each to round-off of its terms. \param d on multiplierMap Collective.
void refuseContradiction(const decomposition::DecomposedProblem& problem,
                         const decomposition::ProblemData& data, const Vector& d);

} // namespace epafi::fetidp
