#include "epafi/linear/LinearParameters.hpp"

#include "epafi/base/Parameters.hpp"

namespace epafi::linear {

Teuchos::ParameterList FetiDpParameters::validParameters() {
  const FetiDpParameters defaults;
  Teuchos::ParameterList list("Epafi FETI-DP");
  addReal(list, "Tolerance", defaults.tolerance,
          "The iteration stops when the residual ‖b − Ku‖ of the solution is this small relative to ‖b‖, "
          "unless the caller asks for another tolerance.",
          0.0, 1.0, true);
  addInteger(list, "Maximum Iterations", defaults.maxIterations, "Conjugate gradient steps at most.", 1);
  fetidp::addFetiParameters(list);
  return list;
}

FetiDpParameters FetiDpParameters::from(const Teuchos::ParameterList& list) {
  return {fetidp::fetiParametersFrom(list), list.get<double>("Tolerance"),
          list.get<int>("Maximum Iterations")};
}

Teuchos::ParameterList BddcParameters::validParameters() {
  Teuchos::ParameterList feti, list("Epafi BDDC");
  fetidp::addFetiParameters(feti);
  list.setEntry("Scaling", feti.sublist("Preconditioner").getEntry("Scaling"));
  list.sublist("Direct Solvers") = feti.sublist("Direct Solvers");
  return list;
}

BddcParameters BddcParameters::from(const Teuchos::ParameterList& list) {
  return {fetidp::directSolversFrom(list.sublist("Direct Solvers")), fetidp::scalingFrom(list)};
}

} // namespace epafi::linear
