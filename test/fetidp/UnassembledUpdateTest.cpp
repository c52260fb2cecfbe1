// Changes of problems that an application hands over, beside solvers made anew.

#include "support/Twice.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

namespace epafi::fetidp {
namespace {

using namespace decomposition;

/// The solution that a solver made anew finds of the problem as it is.
ContactSolution solvedAnew(const UnassembledProblem& handed) {
  ContactSolver solver(toleranceOf(1e-12));
  solver.setup(handed.problem(), handed.data());
  return solver.solve(handed.data());
}

void expectEqualFields(const UnassembledProblem& handed, const ContactSolution& a, const ContactSolution& b) {
  const RCP<Vector> u = handed.unknowns(a.displacement), v = handed.unknowns(b.displacement);
  const double size = v->normInf();
  u->update(-1.0, *v, 1.0);
  EXPECT_LE(u->normInf(), 1e-10 * size);
  EXPECT_GT(size, 0);
}

/// Every second row of a contact matrix, numbered anew, with as much gap again. Collective.
ConstraintMatrix everySecondRow(const ConstraintMatrix& contact) {
  const CrsMatrix& all = *contact.rows;
  const auto number = static_cast<GlobalOrdinal>(all.getGlobalNumRows() + 1) / 2;
  std::vector<GlobalOrdinal> mine;
  for (GlobalOrdinal row = 0; row < number; ++row)
    if (all.getRowMap()->isNodeGlobalElement(2 * row))
      mine.push_back(row);
  const RCP<const Map> rows = rcp(
      new Map(static_cast<Tpetra::global_size_t>(number), Teuchos::arrayViewFromVector(mine), 0, world()));
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(rows, 8));
  const RCP<Vector> gap = rcp(new Vector(rows));
  for (const GlobalOrdinal row : mine) {
    const LocalOrdinal old = all.getRowMap()->getLocalElement(2 * row);
    CrsMatrix::local_inds_host_view_type columns;
    CrsMatrix::values_host_view_type values;
    all.getLocalRowView(old, columns, values);
    for (std::size_t k = 0; k < columns.extent(0); ++k)
      matrix->insertGlobalValues(row, Teuchos::tuple(all.getColMap()->getGlobalElement(columns(k))),
                                 Teuchos::tuple(values(k)));
    gap->replaceGlobalValue(row, 0.01 + 2 * contact.gap->getData()[old]);
  }
  matrix->fillComplete(all.getDomainMap(), rows);
  return {matrix, gap};
}

/// Lets all rows of contact give way alike.
void soften(UnassembledProblem& handed, double compliance) {
  const RCP<Vector> soft = rcp(new Vector(handed.problem().multiplierMap));
  const auto values = soft->getDataNonConst();
  for (LocalOrdinal i = 0; i < values.size(); ++i)
    values[i] = handed.problem().kindOf(OwnedMultiplier(i)) == RowKind::contact ? compliance : 0;
  handed.setCompliance(soft);
}

TEST(UnassembledUpdateTest, UpdatesGiveWhatASolverMadeAnewGives) {
  for (const Case& c : handedCases()) {
    SCOPED_TRACE(c.name);
    Twice twice(c.scene, Supports::prescribed);
    UnassembledProblem& handed = *twice.handed;
    std::vector<SubdomainMatrix> matrices = matricesOf(c.scene, Supports::prescribed);
    ConstraintMatrix contact = contactOf(c.scene, twice.direct.decomposition, Supports::prescribed);
    const auto expectAsAnew = [&](double compliance = 0) {
      const ContactSolution updated = twice.solver->solve(handed.data());
      expectEqualFields(handed, updated, solvedAnew(handed));
      const auto anew = handOver(c.scene, matrices);
      anew->setContact(contact);
      anew->complete();
      if (compliance > 0)
        soften(*anew, compliance);
      const ContactSolution expected = solvedAnew(*anew);
      expectEqualFields(handed, updated, expected);
      EXPECT_NEAR(updated.energy, expected.energy, 1e-9 * std::abs(expected.energy));
      return updated.energy;
    };

    for (std::size_t s = 0; s < matrices.size(); ++s) { // loads and gaps take no update
      matrices[s].load *= matrices[s].body == 0 ? 3.0 : 1.5;
      handed.setLoad(s, matrices[s].load);
    }
    const RCP<Vector> gap = rcp(new Vector(contact.gap->getMap()));
    for (Teuchos_Ordinal i = 0; i < gap->getData().size(); ++i)
      gap->replaceLocalValue(
          static_cast<LocalOrdinal>(i),
          1e-3 * static_cast<double>(gap->getMap()->getGlobalElement(static_cast<LocalOrdinal>(i))));
    contact.gap = gap;
    handed.setGap(*gap);
    expectAsAnew();

    for (std::size_t s = 0; s < matrices.size(); ++s)
      if (matrices[s].body == 0) {
        matrices[s].stiffness *= 3.0;
        handed.setMatrix(s, matrices[s].stiffness);
      }
    twice.solver->update(handed.data());
    expectAsAnew();

    contact = everySecondRow(contact);
    handed.setContact(contact);
    twice.solver->update(handed.data());
    const double hard = expectAsAnew();

    constexpr double compliance = 0.01;
    soften(handed, compliance);
    twice.solver->update(handed.data());
    EXPECT_LT(expectAsAnew(compliance), hard) << "what gives way takes more energy out of the loads";

    handed.setContact(contact); // rows made anew are rigid
    twice.solver->update(handed.data());
    EXPECT_NEAR(expectAsAnew(), hard, 1e-9 * std::abs(hard));
    EXPECT_THROW(soften(handed, -1.0), InputError);
  }
}

TEST(UnassembledUpdateTest, AnUpdateKeepsTheFactorsAndBlocksThatStillHold) {
  Twice twice(twoMembranes(true, 8, grid(2, 2)), Supports::eliminated);
  UnassembledProblem& handed = *twice.handed;
  DirectSolvers solvers;
  solvers.shareIdentical = false;
  auto inverse = std::make_shared<GeneralizedInverse>(handed.problem(), solvers);
  const auto factors = [&] {
    std::vector<const CondensedSubdomain*> result;
    for (const SubdomainGroup& group : inverse->groups())
      result.push_back(&group.condensed());
    return result;
  };
  const auto blocks = [&] {
    std::vector<std::shared_ptr<const direct::SymmetricBlock>> result;
    for (const SubdomainGroup& group : inverse->groups())
      result.push_back(group.boundaryStiffness(direct::SymmetricBlock::Precision::full));
    return result;
  };
  const auto before = factors();
  const auto blocksBefore = blocks();
  const CoarseProblem* coarse = &inverse->coarseProblem();
  inverse = std::make_shared<GeneralizedInverse>(handed.problem(), solvers, std::move(inverse));
  EXPECT_EQ(factors(), before);
  EXPECT_EQ(blocks(), blocksBefore);
  EXPECT_EQ(&inverse->coarseProblem(), coarse);

  const bool isFirst = world()->getRank() == 0;
  if (isFirst)
    handed.setMatrix(0,
                     2.0 * matricesOf(twoMembranes(true, 8, grid(2, 2)), Supports::eliminated)[0].stiffness);
  else
    matricesOf(twoMembranes(true, 8, grid(2, 2)), Supports::eliminated);
  inverse = std::make_shared<GeneralizedInverse>(handed.problem(), solvers, std::move(inverse));
  const auto after = factors();
  const auto blocksAfter = blocks();
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t s = 0; s < after.size(); ++s) {
    EXPECT_EQ(after[s] == before[s], !(isFirst && s == 0)) << s;
    EXPECT_EQ(blocksAfter[s] == blocksBefore[s], !(isFirst && s == 0)) << s;
  }
}

std::vector<const CondensedSubdomain*> factorsOf(const ContactSolver& solver) {
  std::vector<const CondensedSubdomain*> factors;
  for (const SubdomainGroup& group : solver.dualProblem().inverse().groups())
    factors.push_back(&group.condensed());
  return factors;
}

/// The unknowns in a matrix's rows of this rank.
std::vector<GlobalOrdinal> columnsOf(const CrsMatrix& rows) {
  const auto columns = localIndices(*rows.getColMap());
  return {columns.begin(), columns.end()};
}

/// Contact that moves: from every second node of a surface to all of them, and back.
TEST(UnassembledUpdateTest, ContactThatMovesAmongCandidatesCostsNoFactor) {
  int numNew = 0;
  for (const Case& c : handedCases())
    for (const bool isForeseen : {true, false}) {
      SCOPED_TRACE(c.name);
      const model::Decomposition direct = model::decompose(c.scene, world());
      const ConstraintMatrix all = contactOf(c.scene, direct, Supports::prescribed),
                             few = everySecondRow(all);
      const auto handed = handOver(c.scene, matricesOf(c.scene, Supports::prescribed));
      if (isForeseen)
        handed->setCandidates(columnsOf(*all.rows));
      handed->setContact(few);
      handed->complete();
      ContactSolver solver(toleranceOf(1e-12));
      solver.setup(handed->problem(), handed->data());
      const auto before = factorsOf(solver);
      for (const ConstraintMatrix& moved : {all, few}) {
        handed->setContact(moved);
        solver.update(handed->data());
        if (isForeseen) {
          EXPECT_EQ(factorsOf(solver), before);
          const ContactSolution updated = solver.solve(handed->data());
          const auto anew = handOver(c.scene, matricesOf(c.scene, Supports::prescribed));
          anew->setContact(moved);
          anew->complete();
          expectEqualFields(*handed, updated, solvedAnew(*anew));
        } else {
          numNew += factorsOf(solver) != before ? 1 : 0;
        }
      }
    }
  EXPECT_GT(sumOverRanks(*world(), numNew), 0) << "whatever is done, all factors stay";
}

TEST(UnassembledUpdateTest, ACandidateThatNoSubdomainHasIsRefused) {
  const scene::Scene scene = twoMembranes(true, 8, grid(2, 2));
  const auto handed = handOver(scene, matricesOf(scene, Supports::eliminated));
  handed->setCandidates({123456});
  EXPECT_THROW(handed->complete(), InputError);
}

} // namespace
} // namespace epafi::fetidp
