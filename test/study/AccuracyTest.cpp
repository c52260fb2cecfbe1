// The accuracy study: what it knows of its problems, what it measures, and how it judges.

#include "support/TemporaryDirectory.hpp"

#include "AccuracyCase.hpp"
#include "AccuracyPeers.hpp"
#include "AccuracyReport.hpp"
#include "AccuracyTargets.hpp"
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

Row someRow(const char* variant, double seconds, double error) {
  return {{"problem", "coercive"}, {"variant", variant}, {"order", 1},
          {"elements", 16},        {"seconds", seconds}, {"energy_error", error}};
}

/// A problem of the quick study on so many meshes.
AccuracyProblem problemNamed(const std::string& name, int meshes) {
  for (AccuracyProblem& problem : accuracyProblems(true))
    if (problem.name == name) {
      problem.meshes = meshes;
      return problem;
    }
  throw InputError("there is no problem " + name);
}

TEST(AccuracyTableTest, TheFrontIsWhatNothingElseBeats) {
  Table table = accuracyTable();
  table.rows = {someRow("slow and good", 4, 0.01),         someRow("slower and no better", 5, 0.01),
                someRow("fast and bad", 1, 0.1),           someRow("hardly worse", 2, 0.0101),
                someRow("of another problem", 0.1, 0.001), someRow("without a time", notMeasured, 0.01)};
  table.rows[4]["problem"] = "semicoercive";

  markFront(table);

  const auto isOnFront = [&](std::size_t row) { return table.rows[row].number("on_pareto_front") == 1; };
  EXPECT_TRUE(isOnFront(0));
  EXPECT_FALSE(isOnFront(1));
  EXPECT_TRUE(isOnFront(2));
  EXPECT_TRUE(isOnFront(3));
  EXPECT_FALSE(isOnFront(5));
  EXPECT_EQ(fastestLike(table.rows[0], table).number("seconds"), 2) << "an error 1 % larger counts as equal";
  EXPECT_EQ(fastestLike(table.rows[1], table).number("seconds"), 2);
  EXPECT_EQ(fastestLike(table.rows[2], table).number("seconds"), 1);
}

TEST(AccuracyTableTest, CountsDigits) {
  Row row = someRow("default", 0.1, 1e-3);
  row["unknowns"] = 1e4;
  addDigits(row);
  EXPECT_NEAR(row.number("digits_of_accuracy"), 3, 1e-12);
  EXPECT_NEAR(row.number("digits_of_efficacy"), 4, 1e-12);
  EXPECT_NEAR(row.number("digits_of_size"), 4, 1e-12);
}

TEST(AccuracyTableTest, LeavesOutWhatWasNotMeasured) {
  Table table = accuracyTable();
  table.rows = {someRow("default", 2, 0.5)};
  markFront(table);
  const std::string text = table.csv();
  EXPECT_TRUE(text.starts_with(
      "problem,variant,order,elements,tolerance,unknowns,seconds,hessian_multiplications,energy_error,"
      "algebraic_error,estimated_error,on_pareto_front"));
  EXPECT_NE(text.find("coercive,default,1,16,,,2,,0.5,,,"), std::string::npos) << text;
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
  const AccuracyProblem problem = problemNamed("strings", 2);
  const AccuracyReference reference(problem, Tpetra::getDefaultComm());
  for (int level = 0; level < 2; ++level) {
    const double h = 1.0 / (16 << level);
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
  const AccuracyProblem problem = problemNamed("semicoercive", 2);
  const AccuracyReference reference(problem, Tpetra::getDefaultComm());
  const double fine = reference.tight(1).error.energy;
  EXPECT_NEAR(reference.tight(0).error.energy / fine, 2, 0.03);
  EXPECT_NEAR(reference.ownError() / fine, 0.25, 0.01) << "four times finer";
  EXPECT_NEAR(reference.contact().force, 0.25, 1e-8) << "the weight of the floating body";
}

TEST(AccuracyCaseTest, ErrorsOfTheIterationFollowTheTolerance) {
  const AccuracyProblem problem = problemNamed("coercive", 2);
  const auto comm = Tpetra::getDefaultComm();
  const AccuracyReference reference(problem, comm);
  std::vector<Case> variants{
      {"", "rough", "1e-2"}, {"", "fine", "1e-8"}, {"", "balanced", "balanced"}, {"", "nested", "balanced"}};
  variants[3].list.set("Nested", "yes");
  const std::vector<Row> rows = measureVariants(problem, 1, reference, variants, 0, comm);
  ASSERT_EQ(rows.size(), 4);
  const auto of = [&](std::size_t row, const char* column) { return rows[row].number(column); };
  EXPECT_GT(of(0, "algebraic_error"), 1e-3);
  EXPECT_LT(of(1, "algebraic_error"), 1e-6);
  EXPECT_EQ(of(1, "elements"), 32);
  EXPECT_EQ(rows[1].text("tolerance"), "1e-8");
  EXPECT_EQ(of(1, "repeats"), 1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(of(i, "effectivity"), 1, 0.1) << variants[i].name;
    EXPECT_DOUBLE_EQ(of(i, "energy_error"),
                     std::hypot(of(i, "algebraic_error"), of(i, "discretisation_error")));
    EXPECT_LE(of(i, "algebraic_error"), 1.001 * of(i, "estimated_algebraic_error") + 1e-9);
    EXPECT_GT(of(i, "seconds"), 0);
  }
  const char *products = "hessian_multiplications", *all = "all_multiplications";
  for (const std::size_t i : {2, 3})
    EXPECT_LE(of(i, "energy_error"), 1.02 * of(1, "energy_error"));
  EXPECT_EQ(of(2, all), of(2, products));
  EXPECT_GT(of(3, all), of(3, products)) << "and those on the coarse mesh";
  EXPECT_LT(of(3, products), of(2, products)) << "it starts from there";
  EXPECT_GT(of(3, "seconds"), of(3, "finest_seconds"));
}

TEST(AccuracyPeersTest, TakesContactSolversOnMeshesOfTheLadder) {
  const auto comm = Tpetra::getDefaultComm();
  const epafi::test::TemporaryDirectory directory(comm);
  const AccuracyProblem problem = problemNamed("coercive", 1);
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

  const std::vector<Row> rows = peerRows(directory.path(), problem, reference);

  ASSERT_EQ(rows.size(), 1);
  EXPECT_EQ(rows[0].text("variant"), "snesvi_cholmod");
  EXPECT_EQ(rows[0].number("seconds"), 0.5);
  EXPECT_NEAR(rows[0].number("algebraic_error"), 1e-4, 1e-12);
  EXPECT_NEAR(rows[0].number("energy_error"), reference.tight(0).error.energy / reference.norms().energy,
              1e-6);
}

TEST(EffectivityTest, OfAModelProblemIsNearOne) {
  const auto comm = Tpetra::getDefaultComm();
  const std::vector<Row> rows = measureEffectivity("semicoercive", 0, 1, scenes, comm);
  ASSERT_EQ(rows.size(), 2);
  EXPECT_NEAR(rows[0].number("effectivity"), 1, 0.05);
  EXPECT_NEAR(rows[1].number("effectivity"), 1, 0.05);
  EXPECT_NEAR(rows[0].number("discretisation_error") / rows[1].number("discretisation_error"), 2, 0.03);
  EXPECT_THROW(measureEffectivity("no such scene", 0, 1, scenes, comm), InputError);
}

/// Curved elements, whose maps do not settle for points far outside of them; the contact is one element wide.
TEST(EffectivityTest, OfCurvedMeshesIsNotFarFromOne) {
  const std::vector<Row> rows = measureEffectivity("pressed_ring", 5e-3, 1, scenes, Tpetra::getDefaultComm());
  ASSERT_EQ(rows.size(), 1);
  EXPECT_GT(rows[0].number("effectivity"), 0.9);
  EXPECT_LT(rows[0].number("effectivity"), 2.2);
}

/// The error falls with the number of unknowns as where nothing is singular, and no claim fails by more than
/// a tenth.
TEST(AccuracyTargetsTest, ErrorsAreBelowTheirTargetsAndFallAsOnSmoothSolutions) {
  const RCP<const Comm> comm = Tpetra::getDefaultComm();
  const auto rowsOf = [&](const std::string& name, int order, const std::vector<double>& targets,
                          double reference) {
    std::vector<Row> rows = measureTargets(name, order, targets, reference, scenes, comm);
    for (const Row& row : rows) {
      EXPECT_EQ(row.number("met"), 1) << name;
      EXPECT_LE(row.number("true_error"), 1.1 * row.number("target")) << name;
      EXPECT_GE(row.number("effectivity"), 0.5) << name;
      EXPECT_LE(row.number("effectivity"), 2) << name;
    }
    return rows;
  };
  EXPECT_GE(fittedOrder(rowsOf("coercive", 2, {0.02, 0.005, 0.00125}, 4e-4)), 0.9);
  EXPECT_GE(fittedOrder(rowsOf("punch", 2, {0.05, 0.0125, 0.004}, 1.5e-3)), 0.75);
  EXPECT_GE(fittedOrder(rowsOf("punch", 1, {0.2, 0.1, 0.05}, 1e-2)), 0.45);
  EXPECT_GE(fittedOrder(rowsOf("angle", 2, {0.05, 0.02, 0.0075}, 2e-3)), 0.9);
}

TEST(AccuracyTargetsTest, AFittedOrderIsThatOfAPower) {
  EXPECT_NEAR(fittedOrder({{{"unknowns", 10}, {"true_error", 0.1}},
                           {{"unknowns", 1000}, {"true_error", 0.01}},
                           {{"unknowns", 100000}, {"true_error", 0.001}}}),
              0.5, 1e-12);
}

} // namespace
