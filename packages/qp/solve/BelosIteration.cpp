#include "epafi/qp/solve/BelosIteration.hpp"

#include "epafi/base/Compatibility.hpp"

#include <BelosOutputManager.hpp>
#include <BelosPseudoBlockCGIter.hpp>
#include <Teuchos_ParameterList.hpp>

namespace epafi::qp {

BelosOutcome iterate(const RCP<BelosProblem>& problem, const std::vector<int>& columns,
                     const RCP<BelosTest>& test) {
  problem->setProblem(); // residuals afresh
  problem->setLSIndex(columns);
  const auto printer = rcp(new Belos::OutputManager<double>(Belos::Errors));
  Teuchos::ParameterList parameters;
  Belos::PseudoBlockCGIter<double, MultiVector, Operator> iteration(problem, printer, test, parameters);
  BelosOutcome outcome;
  try {
    const RCP<MultiVector> residual =
        Belos::MultiVecTraits<double, MultiVector>::CloneCopy(*problem->getInitResVec(), columns);
    startAt(iteration, residual);
    iteration.iterate();
  } catch (const Belos::BelosError&) {
    outcome.isIndefinite = true;
  }
  outcome.steps = iteration.getNumIters();
  if (!outcome.isIndefinite)
    problem->setCurrLS();
  return outcome;
}

} // namespace epafi::qp
