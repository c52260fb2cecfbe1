#include "epafi/qp/solve/MprgpParameters.hpp"

#include "epafi/base/Parameters.hpp"

#include <string>
#include <vector>

namespace epafi::qp {
namespace {

const std::vector<std::string> expansions = {"auto", "projected CG", "fixed step", "active set"};

} // namespace

Teuchos::ParameterList MprgpParameters::validParameters() {
  const MprgpParameters defaults;
  Teuchos::ParameterList list("MPRGP");
  addReal(list, "Proportioning Constant", defaults.proportioningConstant,
          "Γ: the iterate is called proportional, and stays in its face, while the chopped gradient is no "
          "longer than Γ times the free one. 0: 0.1 for FETI-DP with a preconditioner where bodies float and "
          "SMALBE's penalty is at most 1, or where none does and there are averages along edges, else 1, and "
          "with a preconditioner a tenth of it once a face has lasted 16 steps.",
          0.0, 1e6);
  addChoice(list, "Expansion", expansions.front(),
            "Where a CG step that would leave the feasible set goes instead: the projection of the full CG "
            "step ('projected CG'); from the boundary along the free gradient with a fixed step length; or "
            "where CG in the face and projections lead in turns ('active set'). One that raises the "
            "objective is repeated with the fixed step. 'auto': projected CG and, with a preconditioner, "
            "once one of its steps has raised the objective by more than a little, active set.",
            expansions);
  addReal(list, "Sufficient Share", defaults.sufficientShare,
          "A CG step that would leave the feasible set, but of which at least this share fits, ends at the "
          "boundary and saves the product of an expansion. 1: every such step is followed by an expansion; "
          "0: 0.25 for FETI-DP with a preconditioner, else 1.",
          0.0, 1.0);
  addReal(list, "Expansion Step", defaults.expansionStep,
          "Fixed step length of expansions as a multiple of 1/‖A‖; convergence is proved below 2.", 0.0, 2.0,
          true, true);
  addInteger(list, "Maximum Multiplications", defaults.maxMultiplications,
             "Products with the operator at most, over all outer iterations together; limits CG too. Looked "
             "at before each step, which takes one to three.",
             1);
  addReal(list, "Time Limit", defaults.timeLimit,
          "Seconds after which the iteration stops with the iterate it has; 0 for no limit.", 0.0, 1e9);
  return list;
}

MprgpParameters MprgpParameters::from(const Teuchos::ParameterList& list) {
  MprgpParameters parameters;
  parameters.proportioningConstant = list.get<double>("Proportioning Constant");
  parameters.expansion = enumeratorFrom<Expansion>(list, "Expansion", expansions);
  parameters.sufficientShare = list.get<double>("Sufficient Share");
  parameters.expansionStep = list.get<double>("Expansion Step");
  parameters.maxMultiplications = list.get<int>("Maximum Multiplications");
  parameters.timeLimit = list.get<double>("Time Limit");
  return parameters;
}

} // namespace epafi::qp
