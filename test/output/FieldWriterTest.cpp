// The fields of a small run: each node once, values where they belong, on any number of ranks.

#include "Hdf5Reading.hpp"
#include "SampleRun.hpp"
#include "support/TemporaryDirectory.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/output/FieldWriter.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace epafi::output {
namespace {

using Names = std::set<std::string>;

struct FieldWriterTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};
  scene::Scene scene = test::sampleScene();
  model::Decomposition decomposition = model::decompose(scene, comm);
  fetidp::ContactSolution solution = test::sampleSolution(decomposition);
  simulation::SolvedScene solved{scene, decomposition, solution};
  simulation::Evaluation evaluation = simulation::evaluate(solved);

  [[nodiscard]] FieldFiles write() const {
    return writeFields(directory.path(), "run", solved, evaluation, test::sampleHistory());
  }
};

TEST_F(FieldWriterTest, WritesTwoFilesAndNothingElse) {
  const FieldFiles files = write();
  EXPECT_EQ(files.hdf5, directory.path() / "run.h5");
  EXPECT_EQ(files.xdmf, directory.path() / "run.xdmf");
  EXPECT_EQ(directory.content(), (Names{"run.h5", "run.xdmf"}));
}

TEST_F(FieldWriterTest, EveryNodeAppearsOnceWithItsOwnDisplacement) {
  const auto file = write().hdf5;
  const test::Table points = test::readTable(file, "/bodies/left_body/points");
  const test::Table u = test::readTable(file, "/bodies/left_body/u");
  ASSERT_EQ(points.extent, (std::vector<std::size_t>{30, 3}));
  ASSERT_EQ(u.extent, (std::vector<std::size_t>{30, 1}));
  std::set<std::pair<double, double>> different;
  for (std::size_t k = 0; k < 30; ++k) {
    const Point point{points.values[3 * k], points.values[3 * k + 1], points.values[3 * k + 2]};
    different.emplace(point[0], point[1]);
    EXPECT_NEAR(u.values[k], test::sampleField(point), 1e-14) << "node " << k;
  }
  EXPECT_EQ(different.size(), 30U);
  EXPECT_EQ(test::readTable(file, "/bodies/right/points").extent[0], 35U);
}

TEST_F(FieldWriterTest, CellsGoAroundTheirSubdomains) {
  const auto file = write().hdf5;
  const test::Table cells = test::readTable(file, "/bodies/right/cells");
  const test::Table subdomain = test::readTable(file, "/bodies/right/subdomain");
  ASSERT_EQ(cells.extent, (std::vector<std::size_t>{24, 4}));
  ASSERT_EQ(subdomain.extent, (std::vector<std::size_t>{24}));
  EXPECT_EQ(std::vector<double>(cells.values.begin(), cells.values.begin() + 4),
            (std::vector<double>{0, 1, 8, 7}));
  // Parts 4, 5, 6 of the whole problem, two columns of elements each.
  const std::vector<double> row{4, 4, 5, 5, 6, 6};
  for (std::size_t k = 0; k < 24; ++k)
    EXPECT_EQ(subdomain.values[k], row[k % 6]) << "cell " << k;
}

TEST_F(FieldWriterTest, CrosspointsAreThoseOfTheProblemSupportedOnesToo) {
  const auto file = write().hdf5;
  const test::Table left = test::readTable(file, "/bodies/left_body/crosspoints");
  const test::Table right = test::readTable(file, "/bodies/right/crosspoints");
  EXPECT_EQ(static_cast<GlobalOrdinal>(left.extent[0] + right.extent[0]),
            decomposition.problem.numCrosspoints);
  std::set<std::pair<double, double>> places;
  for (std::size_t k = 0; k < left.extent[0]; ++k)
    places.emplace(left.values[3 * k], left.values[3 * k + 1]);
  EXPECT_EQ(places.count({0.0, 0.5}), 1U) << "on the supported edge";
  EXPECT_EQ(places.count({0.0, 0.0}), 0U) << "corner of the body";
}

TEST_F(FieldWriterTest, ContactRowsFollowTheFirstBodysEdge) {
  const auto file = write().hdf5;
  const std::string group = "/contact/left_right";
  EXPECT_EQ(test::readText(file, group, "name"), "left/right");
  const test::Table points = test::readTable(file, group + "/points");
  ASSERT_EQ(points.extent, (std::vector<std::size_t>{5, 3}));
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_DOUBLE_EQ(points.values[3 * k], 1.0);
    EXPECT_DOUBLE_EQ(points.values[3 * k + 1], static_cast<double>(k) / 4);
  }
  EXPECT_EQ(test::readTable(file, group + "/cells").values, (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(test::readTable(file, group + "/multiplier").values, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(test::readTable(file, group + "/area").values,
            (std::vector<double>{0.125, 0.25, 0.25, 0.25, 0.125}));
  EXPECT_EQ(test::readTable(file, group + "/pressure").values, (std::vector<double>{8, 8, 12, 16, 40}));
  EXPECT_EQ(test::readTable(file, group + "/normal").values,
            (std::vector<double>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(test::readTable(file, group + "/gap").values, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(test::readTable(file, group + "/active").values, (std::vector<double>{1, 0, 1, 0, 1}));
  EXPECT_EQ(test::readTable(file, group + "/initial_gap").values, std::vector<double>(5, 0.25));
}

TEST_F(FieldWriterTest, HistoryHasOneEntryAStep) {
  const auto file = write().hdf5;
  EXPECT_EQ(test::readTable(file, "/history/step").values, (std::vector<double>{'s', 'c', 'e', 'p'}));
  EXPECT_EQ(test::readTable(file, "/history/outer").values, (std::vector<double>{0, 0, 1, 1}));
  EXPECT_EQ(test::readTable(file, "/history/projected_gradient").values,
            (std::vector<double>{1, 0.1, 0.01, 0.001}));
  EXPECT_EQ(test::readTable(file, "/history/hessian_multiplications").values,
            (std::vector<double>{1, 2, 4, 5}));
}

TEST_F(FieldWriterTest, EmptyHistoryIsWrittenToo) {
  writeFields(directory.path(), "run", solved, evaluation, {});
  EXPECT_EQ(test::readTable(directory.path() / "run.h5", "/history/step").values.size(), 0U);
}

TEST_F(FieldWriterTest, SolutionOfAnotherProblemIsAnErrorAndLeavesNoFile) {
  if (comm->getRank() == 0)
    solution.displacement.pop_back();
  EXPECT_THROW(static_cast<void>(write()), Error);
  EXPECT_EQ(directory.content(), Names{});
}

TEST_F(FieldWriterTest, BadNamesAndDirectoriesAreInputErrorsOnAllRanks) {
  const auto at = [&](const std::filesystem::path& place, const std::string& name) {
    static_cast<void>(writeFields(place, name, solved, evaluation, {}));
  };
  EXPECT_THROW(at(directory.path(), ""), InputError);
  EXPECT_THROW(at(directory.path(), "a/b"), InputError);
  at(directory.path(), "run");
  EXPECT_THROW(at(directory.path() / "run.h5", "run"), InputError);
}

} // namespace
} // namespace epafi::output
