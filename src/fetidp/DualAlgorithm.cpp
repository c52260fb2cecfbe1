#include "epafi/fetidp/DualAlgorithm.hpp"

namespace epafi::fetidp {

std::string toString(Algorithm algorithm) {
  switch (algorithm) {
  case Algorithm::direct:
    return "Direct";
  case Algorithm::conjugateGradient:
    return "CG";
  case Algorithm::mprgp:
    return "MPRGP";
  case Algorithm::smalbe:
    return "SMALBE-M";
  }
  return "Unknown";
}

AlgorithmChoice leastAlgorithm(const decomposition::DecomposedProblem& problem) {
  if (problem.dualDimension() == 0)
    return {Algorithm::direct, "one piece without contact: one factorisation solves it, nothing to iterate"};
  if (problem.numInequalities == 0)
    return {Algorithm::conjugateGradient,
            "no contact: the multipliers only glue subdomains, a linear problem"};
  if (problem.kernelDimension == 0)
    return {Algorithm::mprgp, "contact, and every body is held by supports: bound constraints only"};
  std::string names;
  for (const auto& body : problem.bodies)
    if (body.kernelDimension > 0)
      names += (names.empty() ? "" : ", ") + body.name;
  return {Algorithm::smalbe,
          "contact with floating bodies (" + names + "): bounds and equilibrium constraints"};
}

} // namespace epafi::fetidp
