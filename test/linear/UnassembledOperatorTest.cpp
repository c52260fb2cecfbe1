#include "support/LinearSamples.hpp"

#include "support/HandedOver.hpp"
#include "support/Refusal.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/linear/NodalBasis.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <functional>

namespace epafi::linear {
namespace {

TEST(UnassembledOperatorTest, IsTheAssembledMatrix) {
  for (const LinearCase& c : linearCases()) {
    SCOPED_TRACE(c.name);
    const LinearProblem problem(c.scene);
    const Eigen::MatrixXd k = denseOf(*problem.k);
    EXPECT_LE(relativeError(k, denseOf(*assembled(*problem.k))), 1e-14);
    EXPECT_LE(relativeError(k, k.transpose()), 1e-14);
    EXPECT_TRUE(direct::choleskyFactor(k)); // positive definite
  }
}

/// The bodies are cut in many ways, and K and b are those of the body: so is the solution.
TEST(UnassembledOperatorTest, TheSolutionDoesNotDependOnTheCut) {
  const LinearProblem whole(plate(8, decomposition::grid(1, 1)));
  const auto solutionOf = [](const LinearProblem& problem) -> Eigen::MatrixXd {
    return direct::solvedSymmetric(denseOf(*problem.k), denseOf(*problem.load()));
  };
  const Eigen::MatrixXd expected = solutionOf(whole);
  for (const auto& cut : {decomposition::grid(2, 2), decomposition::grid(3, 1), decomposition::metis(5)})
    EXPECT_LE(relativeError(solutionOf(LinearProblem(plate(8, cut))), expected), 1e-12);
}

TEST(UnassembledOperatorTest, AddsMultiplesOfProducts) {
  const LinearProblem problem(plate(6, decomposition::grid(2, 2)));
  const Eigen::MatrixXd loads = denseOf(*problem.load()), x = loads * Eigen::RowVector3d(1, -2, 5),
                        before = Eigen::MatrixXd::Constant(loads.rows(), 3, 0.25) + 2 * x.rowwise().reverse();
  const RCP<MultiVector> y = spreadOn(problem.k->getRangeMap(), before);
  problem.k->apply(*spreadOn(problem.k->getDomainMap(), x), *y, Teuchos::TRANS, -2.0, 0.5);
  EXPECT_LE(relativeError(denseOf(*y), 0.5 * before - 2 * denseOf(*problem.k) * x), 1e-13);
}

/// All nodes of a plate as numbers of the map, supported ones too.
struct WholePlate {
  LinearProblem free{plate(6, decomposition::grid(2, 2))};
  RCP<const Map> map = rcp(new Map(49, 0, world()));
  RCP<const UnassembledOperator> k =
      rcp(new UnassembledOperator(free.k->sharedProblem(), globalUnknowns(*free.decomposition), map));
};

TEST(UnassembledOperatorTest, IsTheIdentityWhereTheMapHasMoreThanTheUnknowns) {
  const WholePlate plate;
  const Eigen::MatrixXd k = denseOf(*plate.k);
  EXPECT_LE(relativeError(k, denseOf(*assembled(*plate.k))), 1e-14);
  std::vector<Eigen::Index> isFree;
  for (Eigen::Index node = 0; node < 49; ++node)
    if (node % 7 > 0 && node < 42) // the left and the upper side are supported
      isFree.push_back(node);
    else
      EXPECT_LE((k.col(node) - Eigen::VectorXd::Unit(49, node)).norm(), 0);
  EXPECT_LE(relativeError(k(isFree, isFree), denseOf(*plate.free.k)), 1e-15);
}

TEST(UnassembledOperatorTest, TakesTheApplicationsMap) {
  const LinearProblem problem(plate(6, decomposition::grid(2, 2)));
  // The same numbers, all on the last rank.
  const auto numbers = denseOf(*problem.load()).rows();
  std::vector<GlobalOrdinal> mine;
  const Map& own = *problem.k->getRangeMap();
  for (GlobalOrdinal number = own.getMinAllGlobalIndex(); number <= own.getMaxAllGlobalIndex(); ++number) {
    const double has = maxOverRanks(*world(), own.isNodeGlobalElement(number) ? 1.0 : 0.0);
    if (has > 0 && world()->getRank() == world()->getSize() - 1)
      mine.push_back(number);
  }
  const RCP<const Map> map = rcp(
      new Map(static_cast<Tpetra::global_size_t>(numbers), Teuchos::arrayViewFromVector(mine), 0, world()));
  const UnassembledOperator elsewhere(problem.k->sharedProblem(), globalUnknowns(*problem.decomposition),
                                      map);
  EXPECT_TRUE(elsewhere.getDomainMap()->isSameAs(*map));
  EXPECT_LE(relativeError(denseOf(elsewhere), denseOf(*problem.k)), 1e-15);
}

/// The number of a subdomain's unknown.
GlobalOrdinal& numberOf(const decomposition::DecomposedProblem& problem, GlobalUnknowns& unknowns,
                        std::size_t s, std::ptrdiff_t unknown) {
  return unknowns[s][problem.subdomains[s].unknownPosition[unknown]];
}

/// What is said of numbers that `change` has changed, on the only rank or on all of several.
std::string
refusalOf(const std::function<void(const decomposition::DecomposedProblem&, GlobalUnknowns&)>& change,
          const scene::Scene& scene = plate(6, decomposition::grid(2, 2))) {
  const LinearProblem problem(scene);
  GlobalUnknowns unknowns = globalUnknowns(*problem.decomposition);
  change(problem.k->problem(), unknowns);
  return test::refusal([&] { UnassembledOperator(problem.k->sharedProblem(), unknowns); });
}

/// An application's own subdomain matrices, prescribed unknowns among them, on its own map.
TEST(UnassembledOperatorTest, IsTheSameOfMatricesThatAnApplicationHandsOver) {
  for (const scene::Scene& scene : {plate(6, decomposition::grid(2, 2)), patchwork(8, 1e3),
                                    elasticBlock(6, 0, test::cutInGrid({2, 2, 1}))}) {
    const std::shared_ptr<decomposition::UnassembledProblem> own =
        decomposition::handOver(scene, decomposition::matricesOf(scene, decomposition::Supports::prescribed));
    own->complete();
    GlobalUnknowns unknowns;
    for (std::size_t s = 0; s < own->numSubdomains(); ++s)
      unknowns.push_back(own->globalUnknowns(s));
    const std::shared_ptr<const decomposition::DecomposedProblem> problem(own, &own->problem());
    const LinearProblem expected(scene);
    const UnassembledOperator free(problem, unknowns);
    EXPECT_LE(relativeError(denseOf(free), denseOf(*expected.k)), 1e-14);
    EXPECT_LE(relativeError(denseOf(*free.load(own->data())), denseOf(*expected.load())), 1e-14);
    const UnassembledOperator all(problem, unknowns, own->unknownMap());
    const GlobalOrdinal numOthers = all.identityRows().size();
    EXPECT_EQ(sumOverRanks(*world(), numOthers) + denseOf(free).rows(), denseOf(all).rows());
  }
}

TEST(UnassembledOperatorTest, RefusesNumbersThatDoNotFit) {
  test::expectSays(refusalOf([](const auto&, GlobalUnknowns& unknowns) { unknowns.emplace_back(); }),
                   {"lists of global unknowns", "give one list for each"});
  test::expectSays(refusalOf([](const auto&, GlobalUnknowns& unknowns) {
                     for (auto& list : unknowns)
                       list.pop_back();
                   }),
                   {"subdomain ", "positions (nodes times components)", "give one for each position"});
  test::expectSays(refusalOf([](const decomposition::DecomposedProblem& problem, GlobalUnknowns& unknowns) {
                     for (std::size_t s = 0; s < unknowns.size(); ++s)
                       numberOf(problem, unknowns, s, 0) = -3;
                   }),
                   {"is -3", "must not be negative"});
}

TEST(UnassembledOperatorTest, RefusesNumbersThatContradictTheGluing) {
  const auto renumberFirst = [](bool crosspoint) {
    return [crosspoint](const decomposition::DecomposedProblem& problem, GlobalUnknowns& unknowns) {
      for (std::size_t s = 0; s < unknowns.size(); ++s)
        if (problem.subdomains[s].number == 0) {
          int unknown = problem.subdomains[s].constraint.front().unknown;
          if (crosspoint)
            unknown = problem.subdomains[s].crosspointUnknowns.front();
          numberOf(problem, unknowns, s, unknown) = 100000;
        }
    };
  };
  test::expectSays(refusalOf(renumberFirst(false)), {"is glued by row", "must have the same"});
  test::expectSays(refusalOf(renumberFirst(true)), {"crosspoint value", "different global numbers"});
  // Two unknowns of a subdomain's interior that are not joined.
  const auto joinInteriors = [](const decomposition::DecomposedProblem& problem, GlobalUnknowns& unknowns) {
    for (std::size_t s = 0; s < unknowns.size(); ++s) {
      std::vector<char> isInterior(problem.subdomains[s].unknownPosition.size(), 1);
      for (const auto& entry : problem.subdomains[s].constraint)
        isInterior[entry.unknown] = 0;
      for (const int unknown : problem.subdomains[s].crosspointUnknowns)
        isInterior[unknown] = 0;
      const auto first = std::find(isInterior.begin(), isInterior.end(), 1) - isInterior.begin();
      const auto second = std::find(isInterior.begin() + first + 1, isInterior.end(), 1) - isInterior.begin();
      numberOf(problem, unknowns, s, first) = numberOf(problem, unknowns, s, second);
    }
  };
  test::expectSays(refusalOf(joinInteriors), {"each number must be one unknown with all its copies"});
}

TEST(UnassembledOperatorTest, RefusesAMapThatLacksANumber) {
  const LinearProblem problem(plate(6, decomposition::grid(2, 2)));
  const RCP<const Map> tooFew = rcp(new Map(3, 0, world()));
  test::expectSays(test::refusal([&] {
                     UnassembledOperator(problem.k->sharedProblem(), globalUnknowns(*problem.decomposition),
                                         tooFew);
                   }),
                   {"the map of the whole problem has no such number"});
}

TEST(NodalBasisTest, ForcesDoTheSameWorkInBothBases) {
  const LinearProblem problem(elasticBlock(4, 3, test::cutInGrid({2, 2, 1})));
  bool hasAverages = false;
  for (const decomposition::Subdomain& subdomain : problem.k->problem().subdomains) {
    hasAverages = hasAverages || !subdomain.averages.empty();
    const Eigen::MatrixXd u = Eigen::MatrixXd::Random(subdomain.stiffness->rows(), 2),
                          f = Eigen::MatrixXd::Random(subdomain.stiffness->rows(), 2);
    Eigen::MatrixXd changed = u, back, forces = f;
    toUnknowns(subdomain, changed);
    back = changed;
    toValues(subdomain, back);
    EXPECT_LE(relativeError(back, u), 1e-14);
    toForcesOfUnknowns(subdomain, forces);
    EXPECT_LE(relativeError(forces.transpose() * changed, f.transpose() * u), 1e-13);
    toForcesOfValues(subdomain, forces);
    EXPECT_LE(relativeError(forces, f), 1e-14);
  }
  EXPECT_GT(maxOverRanks(*world(), hasAverages ? 1.0 : 0.0), 0);
}

} // namespace
} // namespace epafi::linear
