#pragma once

/// Does the contact problem have a solution, and only one?
///
/// A rigid motion α of the floating bodies that the contact allows satisfies G̃ᵀα ≤ 0. A minimiser exists if
/// and only if ẽᵀα ≤ 0 for all of them, that is, if ẽ lies in the cone of the columns of G̃ (Farkas); it is
/// unique if ẽ lies in the interior of that cone.

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/fetidp/equilibrium/MotionWords.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <string>
#include <utility>
#include <vector>

namespace epafi::fetidp {

/// Bodies are free to move: nothing hinders it, or only the facets of smooth surfaces.
class FreeMotionError : public SolvabilityError {
public:
  /// \param what  the sentence for people
  FreeMotionError(Kind kind, const std::string& what, std::vector<FreeMotion> motions)
      : SolvabilityError(kind, what), motions_(std::move(motions)) {}

  [[nodiscard]] const std::vector<FreeMotion>& motions() const { return motions_; } ///< all of them

private:
  std::vector<FreeMotion> motions_;
};

/// Throws SolvabilityError, the same on all ranks, that names the body and the reason if - a rigid motion of
/// the floating bodies meets no contact at all (no solution, or not unique: a FreeMotionError, as where only
/// facets hinder it), - the load pulls, turns or tips
/// a floating body off its contacts (no solution), - the load on it has no resultant against its contacts, or
/// against a motion that they do not hinder, such as one that
///    acts exactly above the edge of the base (not unique).
/// Bodies whose modes are known as motions in space (Body::motions) are said to slide or turn, with direction
/// and axis. What is small is so beside the problem's scales (ProblemScales.hpp).
/// \param entries  this rank's rows of G̃ᵀ, see kernelConstraint
/// Collective.
void requireUniqueSolution(const decomposition::DecomposedProblem& problem,
                           const decomposition::ProblemData& data, const std::vector<KernelEntry>& entries);

/// What no load changes: throws SolvabilityError if a rigid motion of the floating bodies meets no contact at
/// all. Collective.
/// \param data  what the sentence says the loads make of it
void requireContactForEveryMotion(const decomposition::DecomposedProblem& problem,
                                  const decomposition::ProblemData& data,
                                  const std::vector<KernelEntry>& entries);

} // namespace epafi::fetidp
