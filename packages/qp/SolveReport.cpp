#include "epafi/qp/SolveReport.hpp"

namespace epafi::qp {

std::string toString(Status status) {
  switch (status) {
  case Status::converged:
    return "Converged";
  case Status::maxIterations:
    return "MaxIterations";
  case Status::stagnated:
    return "Stagnated";
  case Status::indefiniteOperator:
    return "IndefiniteOperator";
  case Status::infeasible:
    return "Infeasible";
  case Status::notUnique:
    return "NotUnique";
  case Status::notFinite:
    return "NotFinite";
  }
  return "Unknown";
}

std::string explain(Status status) {
  switch (status) {
  case Status::converged:
    return "the tolerance is reached, confirmed by a gradient computed afresh";
  case Status::maxIterations:
    return "the limit of operator products was reached before the tolerance; raise 'Maximum Multiplications' "
           "or the tolerance";
  case Status::stagnated:
    return "round-off allows no smaller residual (attainable accuracy reached); raise the tolerance";
  case Status::indefiniteOperator:
    return "a direction of zero or negative curvature was met: the operator is not positive definite";
  case Status::infeasible:
    return "the constraints contradict each other";
  case Status::notUnique:
    return "the solution is not unique";
  case Status::notFinite:
    return "the operator returned NaN or infinity";
  }
  return "";
}

} // namespace epafi::qp
