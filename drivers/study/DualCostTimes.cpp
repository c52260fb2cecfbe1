#include "DualCostTimes.hpp"

#include "Median.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace epafi::drivers {
namespace {

/// The first half of a product with F: in it the two forms differ.
double secondsPerProduct(fetidp::GeneralizedInverse& inverse,
                         const decomposition::DecomposedProblem& problem) {
  const std::vector<double> lambda(numLocal(*problem.multiplierGhostMap), 1.0);
  std::vector<AccurateSum> coarse(static_cast<std::size_t>(inverse.coarseProblem().size()));
  return medianSeconds(*problem.comm, 0.2, [&] {
    for (fetidp::SubdomainGroup& group : inverse.groups())
      group.applyFlexibility(lambda, coarse, 1);
  });
}

/// Sums of what rates refer to.
struct Work {
  double factorEntries = 0, blockEntries = 0, cubes = 0;
};

Work addUp(const fetidp::GeneralizedInverse& inverse, DualCostTimes& times) {
  Work work;
  for (const fetidp::SubdomainGroup& group : inverse.groups()) {
    const fetidp::DualCosts costs = expectedCosts(group);
    times.expected.implicitProduct += costs.implicitProduct;
    times.expected.explicitProduct += costs.explicitProduct;
    times.expected.explicitSetup += costs.explicitSetup;
    const auto size = static_cast<double>(group.condensed().numBoundary());
    const auto members = static_cast<double>(group.members().size());
    times.boundary = std::max(times.boundary, size);
    work.factorEntries += members * static_cast<double>(group.condensed().factor().numEntries());
    work.blockEntries += members * size * size;
    work.cubes += std::pow(size, 3);
  }
  return work;
}

DualCostTimes timeOne(int subdomainsPerSide, int elementsPerSide, bool isShared) {
  const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  const decomposition::Decomposition cut = decomposition::decompose(
      scene::modelProblem(true, subdomainsPerSide, subdomainsPerSide * elementsPerSide), alone);
  fetidp::DirectSolvers solvers;
  solvers.shareIdentical = isShared;
  fetidp::GeneralizedInverse inverse(cut.problem, solvers);
  DualCostTimes times;
  times.elementsPerSide = elementsPerSide;
  times.isShared = isShared;
  const Work work = addUp(inverse, times);
  times.measured.implicitProduct = secondsPerProduct(inverse, cut.problem);
  times.measured.explicitSetup = medianSeconds(*alone, 0.1, [&] {
    for (const fetidp::SubdomainGroup& group : inverse.groups())
      const direct::SymmetricBlock block(group.condensed().factor().inverseOfKept(), group.use());
  });
  for (fetidp::SubdomainGroup& group : inverse.groups())
    group.makeExplicit();
  times.measured.explicitProduct = secondsPerProduct(inverse, cut.problem);
  times.factorRate = 2 * work.factorEntries / times.measured.implicitProduct;
  times.blockRate = (isShared ? 2 : 1) * work.blockEntries / times.measured.explicitProduct;
  times.inverseRate = 2.0 / 3.0 * work.cubes / times.measured.explicitSetup;
  return times;
}

} // namespace

double DualCostTimes::payoff(const fetidp::DualCosts& costs) {
  return costs.implicitProduct > costs.explicitProduct
             ? costs.explicitSetup / (costs.implicitProduct - costs.explicitProduct)
             : std::numeric_limits<double>::infinity();
}

std::vector<DualCostTimes> timeDualCosts(int subdomainsPerSide, const std::vector<int>& elementsPerSide) {
  std::vector<DualCostTimes> times;
  for (const bool isShared : {false, true})
    for (const int elements : elementsPerSide)
      times.push_back(timeOne(subdomainsPerSide, elements, isShared));
  return times;
}

std::string costsCsv(const std::vector<DualCostTimes>& times) {
  std::ostringstream csv;
  csv << "H_over_h,shared,boundary,implicit_seconds,explicit_seconds,explicit_setup_seconds,payoff_products,"
         "expected_implicit_seconds,expected_explicit_seconds,expected_explicit_setup_seconds,"
         "expected_payoff_products,factor_rate,block_rate,inverse_rate\n";
  for (const DualCostTimes& row : times) {
    csv << row.elementsPerSide << ',' << row.isShared << ',' << row.boundary;
    for (const fetidp::DualCosts& costs : {row.measured, row.expected})
      csv << ',' << costs.implicitProduct << ',' << costs.explicitProduct << ',' << costs.explicitSetup << ','
          << DualCostTimes::payoff(costs);
    csv << ',' << row.factorRate << ',' << row.blockRate << ',' << row.inverseRate << '\n';
  }
  return csv.str();
}

} // namespace epafi::drivers
