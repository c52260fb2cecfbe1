#include "support/Gathered.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::decomposition {
namespace {

RCP<const Comm> oneRank() {
  return rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
}

void expectSameSubdomain(const DecomposedProblem& a, const Subdomain& s, const DecomposedProblem& b,
                         const Subdomain& t) {
  EXPECT_EQ(s.body, t.body);
  EXPECT_EQ(s.number, t.number);
  EXPECT_EQ(s.nodes, t.nodes);
  EXPECT_EQ(s.unknownPosition, t.unknownPosition);
  EXPECT_EQ(s.remainderUnknowns, t.remainderUnknowns);
  EXPECT_EQ(s.crosspointUnknowns, t.crosspointUnknowns);
  EXPECT_EQ(s.crosspointIndices, t.crosspointIndices);
  EXPECT_EQ(Eigen::MatrixXd(*s.stiffness), Eigen::MatrixXd(*t.stiffness));
  ASSERT_EQ(s.constraint.size(), t.constraint.size());
  for (std::size_t k = 0; k < s.constraint.size(); ++k) {
    EXPECT_EQ(a.multiplierGhostMap->getGlobalElement(s.constraint[k].multiplier),
              b.multiplierGhostMap->getGlobalElement(t.constraint[k].multiplier));
    EXPECT_EQ(s.constraint[k].unknown, t.constraint[k].unknown);
    EXPECT_EQ(s.constraint[k].coefficient, t.constraint[k].coefficient);
  }
}

TEST(RankTest, EverySubdomainIsTheSameOnAnyNumberOfRanks) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    const auto shared = decompose(c.scene, world()), alone = decompose(c.scene, oneRank());
    const DecomposedProblem &p = shared.problem, &q = alone.problem;
    EXPECT_EQ(p.primalDimension, q.primalDimension);
    EXPECT_EQ(p.numInequalities, q.numInequalities);
    EXPECT_EQ(p.numEqualities, q.numEqualities);
    EXPECT_EQ(p.numCrosspoints, q.numCrosspoints);
    ASSERT_EQ(q.subdomains.size(), static_cast<std::size_t>(q.numSubdomains));
    for (std::size_t k = 0; k < p.subdomains.size(); ++k) {
      const std::size_t same = p.subdomains[k].number;
      expectSameSubdomain(p, p.subdomains[k], q, q.subdomains[same]);
      EXPECT_EQ(shared.data.subdomains()[k].load, alone.data.subdomains()[same].load);
    }
    const auto mine = shared.data.gap().getData(), all = alone.data.gap().getData();
    for (Teuchos_Ordinal k = 0; k < mine.size(); ++k)
      EXPECT_EQ(
          mine[k],
          all[q.multiplierMap->getLocalElement(p.multiplierMap->getGlobalElement(static_cast<int>(k)))]);
  }
}

TEST(RankTest, RanksTakeContiguousRunsAndMayBeEmpty) {
  const auto result = decompose(oneBody(6, 6, grid(1, 3), {}), world());
  const int rank = world()->getRank(), ranks = world()->getSize();
  ASSERT_EQ(static_cast<int>(result.problem.subdomains.size()), (rank + 1) * 3 / ranks - rank * 3 / ranks);
  for (std::size_t k = 0; k < result.problem.subdomains.size(); ++k)
    EXPECT_EQ(result.problem.subdomains[k].number, rank * 3 / ranks + static_cast<int>(k));
}

TEST(RankTest, OneSubdomainOnManyRanksIsAccepted) {
  const auto result = decompose(oneBody(3, 3, metis(1), {{"left", "left", {0.0}}}), world());
  EXPECT_EQ(result.problem.dualDimension(), 0);
  EXPECT_EQ(result.problem.numCrosspoints, 0);
  EXPECT_EQ(result.problem.primalDimension, 16);
}

} // namespace
} // namespace epafi::decomposition
