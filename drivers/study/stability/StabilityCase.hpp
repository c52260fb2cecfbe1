#pragma once

/// A hard case: what is tried, what is expected of it, and how it is tried. And what came of it.

#include "epafi/base/Types.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace epafi::drivers {

/// How a run may end. `solved` is what a check that knows nothing of the solver's bookkeeping has confirmed;
/// an answer that is claimed but not confirmed is `wrongAnswer`, the worst of all.
enum class Outcome { solved, noSolution, notUnique, wrongInput, stopped, wrongAnswer, failed };

/// "solved", "refused: no solution", …
std::string toString(Outcome outcome);

/// What is expected, written before the run: one of these ends, the reason of which contains `keyword`.
struct Expectation {
  /// From "solved or stopped", "no solution: pulls", … \throws InputError if it names no outcome
  explicit Expectation(const std::string& words);
  std::vector<Outcome> outcomes = {};
  std::string keyword = {};
};

/// "solved", "refused: no solution (pulls)", "solved or stopped", …
std::string toString(const Expectation& expectation);

/// NaN: not known, or without meaning here.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct CaseResult {
  Outcome outcome = Outcome::failed;
  std::string status; ///< of the solver; empty if it was not reached
  std::string reason; ///< in words: the solver's, the error's, or what the check found
  int products = 0;   ///< with F, or with the Hessian
  int normProducts = 0;
  double projectedGradient = unknown; ///< relative, recomputed
  // Recomputed without the solver; see UndecomposedSolution.hpp.
  double balance = unknown, penetration = unknown, complementarity = unknown;
  double energyError = unknown; ///< ‖u − u*‖_K relative to ‖u*‖_K, u* by a direct solver
  double energy = unknown, force = unknown;
  long long active = -1;
  double seconds = 0;

  /// A solved case of which a check has something to say is a wrong answer.
  void judge(const std::string& complaint);
};

struct StabilityCase {
  std::string family;    ///< one of those in cases/stability.cases
  std::string name;      ///< what is hard
  std::string parameter; ///< how hard, in words
  Expectation expected{"solved"};
  std::function<CaseResult(const RCP<const Comm>&)> run = {}; ///< collective
  double value = unknown;                                     ///< how hard, as a number where there is one
  std::string variant = "default";                            ///< "plain": without preconditioner
  int ranks = 0;                                              ///< how many it takes; 0: as many as there are
};

/// Those of a family, or all if it is empty. Quick ones are small enough for tests.
std::vector<StabilityCase> stabilityCases(const std::string& family, bool quick);

/// Runs it; whatever is thrown becomes an outcome. Collective over `comm`, which has the ranks that the case
/// takes.
CaseResult runCase(const StabilityCase& trial, const RCP<const Comm>& comm);

[[nodiscard]] bool isAsExpected(const Expectation& expectation, const CaseResult& result);

} // namespace epafi::drivers
