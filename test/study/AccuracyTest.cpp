// The accuracy study: what it knows of its problems, what it measures, and how it judges.

#include "../output/TemporaryDirectory.hpp"

#include "AccuracyCase.hpp"
#include "AccuracyPeers.hpp"
#include "AccuracyReport.hpp"
#include "Effectivity.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace {

using namespace epafi;
using namespace epafi::drivers;

const std::filesystem::path scenes = std::filesystem::path(EPAFI_SOURCE_DIR) / "xml";

AccuracyRow someRow(const char* variant, double seconds, double error) {
  AccuracyRow row;
  row.problem = "coercive";
  row.variant = variant;
  row.elements = 16;
  row.seconds = seconds;
  row.energyError = error;
  return row;
}

TEST(AccuracyTableTest, TheFrontIsWhatNothingElseBeats) {
  AccuracyTable table;
  table.add(someRow("slow and good", 4, 0.01));
  table.add(someRow("slower and no better", 5, 0.01));
  table.add(someRow("fast and bad", 1, 0.1));
  table.add(someRow("hardly worse", 2, 0.0101));
  AccuracyRow other = someRow("of another problem", 0.1, 0.001);
  other.problem = "semicoercive";
  table.add(other);
  table.add(someRow("without a time", AccuracyRow::unknown, 0.01));

  table.markFront();

  const std::vector<AccuracyRow>& rows = table.rows();
  EXPECT_TRUE(rows[0].isOnFront);
  EXPECT_FALSE(rows[1].isOnFront);
  EXPECT_TRUE(rows[2].isOnFront);
  EXPECT_TRUE(rows[3].isOnFront);
  EXPECT_FALSE(rows[5].isOnFront);
  EXPECT_EQ(table.distanceToFront(rows[0]), 2) << "an error 1 % larger counts as equal";
  EXPECT_EQ(table.distanceToFront(rows[1]), 2.5);
  EXPECT_EQ(table.distanceToFront(rows[2]), 1);
}

TEST(AccuracyTableTest, CountsDigits) {
  AccuracyRow row = someRow("default", 0.1, 1e-3);
  row.unknowns = 1e4;
  EXPECT_NEAR(row.digitsOfAccuracy(), 3, 1e-12);
  EXPECT_NEAR(row.digitsOfEfficacy(), 4, 1e-12);
  EXPECT_NEAR(row.digitsOfSize(), 4, 1e-12);
}

TEST(AccuracyTableTest, LeavesOutWhatWasNotMeasured) {
  AccuracyTable table;
  table.add(someRow("default", 2, 0.5));
  const std::string text = table.csv();
  EXPECT_EQ(text.substr(0, text.find('\n'))
                .rfind("problem,variant,elements,tolerance,unknowns,seconds,"
                       "hessian_multiplications,energy_error,algebraic_error,"
                       "estimated_error,on_pareto_front",
                       0),
            0);
  EXPECT_NE(text.find("coercive,default,16,,,2,,0.5,,,0,"), std::string::npos) << text;
}

TEST(AccuracyReferenceTest, ExtrapolatesErrorsOfAnyOrder) {
  for (const double order : {0.6, 1.0, 2.0}) {
    const double own = 0.01; // of the reference; C²h^{2p}
    const auto distance = [&](double factor) { return own * std::sqrt(std::pow(factor, 2 * order) - 1); };
    EXPECT_NEAR(referenceError(distance(2), distance(4)), own, 1e-12) << order;
  }
  EXPECT_EQ(referenceError(0, 0), 0) << "a patch test";
}

TEST(AccuracyReferenceTest, StringsHaveTheErrorOfTheTextbook) {
  // Exact at the nodes: ∫ (u' − u_h')² = f² h²/12 a length. ‖u‖² = ∫ u'².
  const AccuracyProblem problem = stringsProblem(8, 2);
  const AccuracyReference reference(problem, Tpetra::getDefaultComm());
  for (int level = 0; level < 2; ++level) {
    const double h = 1.0 / (8 << level);
    EXPECT_NEAR(reference.tight(level).error.energy, h * std::sqrt((1.0 + 9.0) / 12), 1e-9);
    EXPECT_NEAR(reference.tight(level).contact.area, 1, 1e-12);
  }
  EXPECT_NEAR(reference.contact().force, 0.5, 1e-9);
  // u₁ = x²/2 − 3x/2, and 3t²/2 − 5t/2 in t = 2 − x.
  EXPECT_NEAR(reference.norms().energy,
              std::sqrt((1.0 / 3 - 3.0 / 2 + 9.0 / 4) + (3.0 - 15.0 / 2 + 25.0 / 4)), 1e-9);
  EXPECT_EQ(reference.ownError(), 0);
}

TEST(AccuracyReferenceTest, ItsOwnErrorIsContainedInThatOfTheMeshes) {
  const AccuracyProblem problem = membranesProblem(false, 16, 2);
  const AccuracyReference reference(problem, Tpetra::getDefaultComm());
  const double fine = reference.tight(1).error.energy;
  EXPECT_NEAR(reference.tight(0).error.energy / fine, 2, 0.03);
  EXPECT_NEAR(reference.ownError() / fine, 0.25, 0.01) << "four times finer";
  EXPECT_NEAR(reference.contact().force, 0.25, 1e-8) << "the weight of the floating body";
}

TEST(AccuracyCaseTest, ErrorsOfTheIterationFollowTheTolerance) {
  const AccuracyProblem problem = membranesProblem(true, 16, 2);
  const auto comm = Tpetra::getDefaultComm();
  const AccuracyReference reference(problem, comm);
  std::vector<AccuracyVariant> variants{{"rough", "1e-2", "", "", "", false},
                                        {"fine", "1e-8", "", "", "", false},
                                        {"balanced", "balanced", "", "", "", false},
                                        {"nested", "balanced", "", "", "", true}};
  const std::vector<AccuracyRow> rows = measureVariants(problem, 1, reference, variants, 0, comm);
  ASSERT_EQ(rows.size(), 4);
  EXPECT_GT(rows[0].algebraicError, 1e-3);
  EXPECT_LT(rows[1].algebraicError, 1e-6);
  EXPECT_EQ(rows[1].elements, 32);
  EXPECT_EQ(rows[1].tolerance, "1e-8");
  EXPECT_EQ(rows[1].repeats, 1);
  for (const AccuracyRow& row : rows) {
    EXPECT_NEAR(row.effectivity(), 1, 0.1) << row.variant;
    EXPECT_DOUBLE_EQ(row.energyError, std::hypot(row.algebraicError, row.discretisationError));
    EXPECT_LE(row.algebraicError, 1.001 * row.estimatedAlgebraic + 1e-9);
    EXPECT_GT(row.seconds, 0);
  }
  for (const int i : {2, 3})
    EXPECT_LE(rows[static_cast<std::size_t>(i)].energyError, 1.02 * rows[1].energyError);
  EXPECT_EQ(rows[2].allProducts, rows[2].products);
  EXPECT_GT(rows[3].allProducts, rows[3].products) << "and those on the coarse mesh";
  EXPECT_LT(rows[3].products, rows[2].products) << "it starts from there";
  EXPECT_GT(rows[3].seconds, rows[3].finestSeconds);
}

TEST(AccuracyPeersTest, TakesContactSolversOnMeshesOfTheLadder) {
  const auto comm = Tpetra::getDefaultComm();
  const output::test::TemporaryDirectory directory(comm);
  const AccuracyProblem problem = membranesProblem(true, 16, 1);
  const AccuracyReference reference(problem, comm);
  EXPECT_TRUE(peerRows(directory.path(), problem, reference).empty()) << "no file";
  comm->barrier(); // all have looked
  if (comm->getRank() == 0) {
    std::filesystem::create_directories(directory.path() / "peers" / "16");
    std::ofstream(directory.path() / "peers" / "16" / "peers.csv")
        << "problem,unknowns,solver,total_seconds,energy_error,size,tolerance,status,repeats,reason\n"
           "coercive,544,snesvi_cholmod,0.5,1e-8,16,1e-06,ok,3,\n"
           "coercive,544,epafi,0.1,1e-8,16,1e-06,ok,3,\n"
           "coercive,2112,snesvi_cholmod,0.5,1e-8,32,1e-06,ok,3,\n"
           "coercive,544,snesvi_hypre,,,16,1e-06,missing,0,\"install it, please\"\n";
    std::ofstream(directory.path() / "peers.csv") << "problem,size\n";
  }
  comm->barrier();
  EXPECT_THROW(peerRows(directory.path(), problem, reference), InputError) << "no table of peers";
  comm->barrier();
  if (comm->getRank() == 0)
    std::filesystem::remove(directory.path() / "peers.csv");
  comm->barrier();

  const std::vector<AccuracyRow> rows = peerRows(directory.path(), problem, reference);

  ASSERT_EQ(rows.size(), 1);
  EXPECT_EQ(rows[0].variant, "snesvi_cholmod");
  EXPECT_EQ(rows[0].seconds, 0.5);
  EXPECT_NEAR(rows[0].algebraicError, 1e-4, 1e-12);
  EXPECT_NEAR(rows[0].energyError, reference.tight(0).error.energy / reference.norms().energy, 1e-6);
}

TEST(EffectivityTest, OfAModelProblemIsNearOne) {
  const std::vector<EffectivityRow> rows =
      measureEffectivity({"semicoercive", 2}, scenes, Tpetra::getDefaultComm());
  ASSERT_EQ(rows.size(), 2);
  EXPECT_NEAR(rows[0].effectivity(), 1, 0.05);
  EXPECT_NEAR(rows[1].effectivity(), 1, 0.05);
  EXPECT_NEAR(rows[0].error / rows[1].error, 2, 0.03);
  EXPECT_THROW(measureEffectivity({"no such scene", 2}, scenes, Tpetra::getDefaultComm()), InputError);
}

} // namespace
