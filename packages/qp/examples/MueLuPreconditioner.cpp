#include "MueLuPreconditioner.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <Tpetra_CrsMatrix.hpp>

epafi::RCP<epafi::Operator> makeMueLu(const epafi::RCP<epafi::CrsMatrix>& a) {
  Teuchos::ParameterList parameters;
  parameters.set("verbosity", "none");
  parameters.set("problem: symmetric", true);
  // Symmetric, and the same on any number of ranks; KLU2 on the coarsest level, the default, is wrong on more
  // than one rank in Trilinos 13.2.
  parameters.set("smoother: type", "CHEBYSHEV");
  parameters.sublist("smoother: params").set("chebyshev: degree", 3);
  parameters.set("coarse: max size", 100);
  parameters.set("coarse: type", "CHEBYSHEV");
  parameters.sublist("coarse: params").set("chebyshev: degree", 5);
  return MueLu::CreateTpetraPreconditioner(epafi::RCP<epafi::Operator>(a), parameters);
}
