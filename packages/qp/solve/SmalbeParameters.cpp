#include "epafi/base/Parameters.hpp"
#include "epafi/qp/solve/Smalbe.hpp"

#include <string>
#include <vector>

namespace epafi::qp {
namespace {

const std::vector<std::string> updates = {"both", "balance", "penalty"};

} // namespace

Teuchos::ParameterList SmalbeParameters::validParameters() {
  const SmalbeParameters defaults;
  Teuchos::ParameterList list("SMALBE");
  addChoice(
      list, "Update", "both",
      "What changes when the augmented Lagrangian grew by less than ρ/2‖Bx − c‖²: the balance M (SMALBE-M) "
      "or the penalty ρ (SMALBE-ρ). 'both' is 'balance', and ρ grows where ‖Bx − c‖ falls slowly.",
      updates);
  addReal(list, "Penalty", defaults.penalty, "ρ‖B‖² as a multiple of ‖A‖ (in FETI-DP: ρ of ‖PFP‖).", 0.0,
          1e12, true);
  addReal(list, "Balance", defaults.balance,
          "M‖B‖ at the start as a multiple of ‖A‖: inner loops stop at ‖gᴾ‖ ≤ M‖Bx − c‖.", 0.0, 1e12, true);
  addReal(list, "Balance Reduction", defaults.balanceReduction,
          "Factor on M, with Update 'balance' or 'both'.", 0.0, 1.0, true, true);
  addReal(list, "Penalty Growth", defaults.penaltyGrowth, "Factor on ρ, with Update 'penalty' or 'both'.",
          1.0, 1e6, true);
  addInteger(list, "Maximum Outer Iterations", defaults.maxOuterIterations,
             "Updates of the multiplier of the equality constraints at most.", 1);
  return list;
}

SmalbeParameters SmalbeParameters::from(const Teuchos::ParameterList& list) {
  SmalbeParameters parameters;
  parameters.update = enumeratorFrom<Update>(list, "Update", updates);
  parameters.penalty = list.get<double>("Penalty");
  parameters.balance = list.get<double>("Balance");
  parameters.balanceReduction = list.get<double>("Balance Reduction");
  parameters.penaltyGrowth = list.get<double>("Penalty Growth");
  parameters.maxOuterIterations = list.get<int>("Maximum Outer Iterations");
  return parameters;
}

} // namespace epafi::qp
