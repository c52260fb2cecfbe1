#include "DualCostTimes.hpp"

#include "Median.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::drivers {
namespace {

/// The first half of a product with F: in it the two forms differ.
double secondsPerProduct(const fetidp::GeneralizedInverse& inverse,
                         const decomposition::DecomposedProblem& problem) {
  const std::vector<double> lambda(numLocal(*problem.multiplierGhostMap), 1.0);
  std::vector<AccurateSum> coarse(inverse.coarseProblem().size());
  std::vector<fetidp::SubdomainGroup::Workspace> work(inverse.groups().size());
  return medianSeconds(*problem.comm, 0.2, [&] {
    for (std::size_t g = 0; g < work.size(); ++g)
      inverse.groups()[g].applyFlexibility(lambda, coarse, 1, work[g]);
  });
}

/// Sums of what rates refer to.
struct Work {
  explicit Work(const fetidp::GeneralizedInverse& inverse) {
    for (const fetidp::SubdomainGroup& group : inverse.groups()) {
      const fetidp::DualCosts costs = expectedCosts(group);
      expected.implicitProduct += costs.implicitProduct;
      expected.explicitProduct += costs.explicitProduct;
      expected.explicitSetup += costs.explicitSetup;
      const auto size = static_cast<double>(group.condensed().numBoundary());
      const auto members = static_cast<double>(group.members().size());
      boundary = std::max(boundary, size);
      factorEntries += members * static_cast<double>(group.condensed().factor().numKeptEntries());
      blockEntries += members * size * size;
      cubes += std::pow(size, 3);
    }
  }
  fetidp::DualCosts expected;
  double boundary = 0, factorEntries = 0, blockEntries = 0, cubes = 0;
};

Row timeOne(int subdomainsPerSide, int elementsPerSide, bool isShared) {
  const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  const model::Decomposition cut = model::decompose(
      scene::modelProblem(true, subdomainsPerSide, subdomainsPerSide * elementsPerSide), alone);
  fetidp::DirectSolvers solvers;
  solvers.shareIdentical = isShared;
  fetidp::GeneralizedInverse inverse(cut.problem, solvers);
  const Work work(inverse);
  fetidp::DualCosts measured;
  measured.implicitProduct = secondsPerProduct(inverse, cut.problem);
  measured.explicitSetup = medianSeconds(*alone, 0.1, [&] {
    for (const fetidp::SubdomainGroup& group : inverse.groups())
      const direct::SymmetricBlock block(group.condensed().factor().inverseOfKept(), group.use());
  });
  inverse.prepareDual({fetidp::DualOperatorParameters::Mode::explicitBlocks, 0});
  measured.explicitProduct = secondsPerProduct(inverse, cut.problem);
  Row row{{"H_over_h", elementsPerSide},
          {"shared", isShared},
          {"boundary", work.boundary},
          {"factor_rate", 2 * work.factorEntries / measured.implicitProduct},
          {"block_rate", (isShared ? 2 : 1) * work.blockEntries / measured.explicitProduct},
          {"inverse_rate", 2.0 / 3.0 * work.cubes / measured.explicitSetup}};
  for (const auto& [prefix, costs] : {std::pair{"", measured}, {"expected_", work.expected}}) {
    row[std::string(prefix).append("implicit_seconds")] = costs.implicitProduct;
    row[std::string(prefix).append("explicit_seconds")] = costs.explicitProduct;
    row[std::string(prefix).append("explicit_setup_seconds")] = costs.explicitSetup;
    row[std::string(prefix).append("payoff_products")] = payoffOf(costs);
  }
  return row;
}

} // namespace

double payoffOf(const fetidp::DualCosts& costs) {
  return costs.implicitProduct > costs.explicitProduct
             ? costs.explicitSetup / (costs.implicitProduct - costs.explicitProduct)
             : std::numeric_limits<double>::infinity();
}

Table timeDualCosts(int subdomainsPerSide, const std::vector<int>& elementsPerSide) {
  Table table(
      "H_over_h,shared,boundary,implicit_seconds,explicit_seconds,explicit_setup_seconds,payoff_products,"
      "expected_implicit_seconds,expected_explicit_seconds,expected_explicit_setup_seconds,"
      "expected_payoff_products,factor_rate,block_rate,inverse_rate");
  for (const bool isShared : {false, true})
    for (const int elements : elementsPerSide)
      table.rows.push_back(timeOne(subdomainsPerSide, elements, isShared));
  return table;
}

} // namespace epafi::drivers
