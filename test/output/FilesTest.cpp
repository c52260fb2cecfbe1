// Text files: atomic writing, names, history table, XML report.

#include "support/TemporaryDirectory.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/FileSet.hpp"
#include "epafi/output/Report.hpp"
#include "epafi/output/SafeNames.hpp"

#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace epafi::output {
namespace {

using Names = std::set<std::string>;

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct FilesTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};
};

TEST_F(FilesTest, TextFileAppearsCompleteAndAlone) {
  const auto file = directory.path() / "text.txt";
  writeTextFile(
      file, [] { return std::string("first"); }, *comm);
  writeTextFile(
      file, [] { return std::string("second"); }, *comm);
  EXPECT_EQ(directory.content(), Names{"text.txt"});
  EXPECT_EQ(contentOf(file), "second");
}

TEST_F(FilesTest, FailureLeavesTheOlderFileAsItWas) {
  const auto file = directory.path() / "text.txt";
  writeTextFile(
      file, [] { return std::string("older"); }, *comm);
  EXPECT_THROW(writeTextFile(
                   file, []() -> std::string { throw Error("no text"); }, *comm),
               Error);
  EXPECT_EQ(directory.content(), Names{"text.txt"});
  EXPECT_EQ(contentOf(file), "older");
}

TEST_F(FilesTest, SetHasNoNamesBeforeAllOfItIsThere) {
  const auto text = [] { return std::string("new"); };
  const auto first = directory.path() / "first", last = directory.path() / "last";
  writeTextFile(
      first, [] { return std::string("older"); }, *comm);
  {
    FileSet files(comm), part(comm);
    files.write(first, text);
    part.write(last, text);
    files.take(part);
    EXPECT_EQ(contentOf(first), "older");
    EXPECT_EQ(directory.content().count("last"), 0U);
    files.publish();
    EXPECT_EQ(contentOf(first) + contentOf(last), "newnew");
    files.write(first, [] { return std::string("given up"); });
  }
  EXPECT_EQ(directory.content(), (Names{"first", "last"}));
  EXPECT_EQ(contentOf(first), "new");
}

TEST_F(FilesTest, SetTakesAwayWhatMeansNothingWithoutTheOthers) {
  const auto text = [] { return std::string("text"); };
  const auto data = directory.path() / "data", about = directory.path() / "about";
  writeTextFile(about, text, *comm);
  FileSet files(comm, false);
  files.write(data, text);
  files.write(about, text, FileSet::Older::goesFirst);
  comm->barrier();
  if (comm->getRank() == 0) // so that the first cannot be put in place
    std::filesystem::create_directory(data);
  EXPECT_THROW(files.publish(), Error);
  EXPECT_EQ(directory.content(), Names{"data"}) << "the other text would be beside data that it is not about";
}

TEST_F(FilesTest, MissingDirectoriesAreMade) {
  const auto file = directory.path() / "a" / "b" / "text.txt";
  writeTextFile(
      file, [] { return std::string("text"); }, *comm);
  EXPECT_EQ(contentOf(file), "text");
}

TEST_F(FilesTest, DirectoryThatCannotBeMadeIsAnInputErrorOnAllRanks) {
  writeTextFile(
      directory.path() / "file", [] { return std::string(); }, *comm);
  const auto impossible = directory.path() / "file" / "below";
  try {
    prepareTarget(impossible / "text.txt", *comm);
    FAIL() << "no error on rank " << comm->getRank();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(impossible.string()), std::string::npos) << error.what();
  }
}

TEST_F(FilesTest, FileThatIsADirectoryIsAnInputErrorOnAllRanks) {
  EXPECT_THROW(prepareTarget(directory.path(), *comm), InputError);
}

TEST_F(FilesTest, ReportReadsBackAsTheSameList) {
  Teuchos::ParameterList report("Report");
  report.sublist("Iterations").set("CG Steps", 12);
  report.sublist("Accuracy").set("Energy", -0.1179435511612625);
  report.sublist("Status").set("Reason", std::string("‖g‖ < 1e-6 & done"));
  const auto file = directory.path() / "report.xml";
  writeReport(report, file, *comm);
  EXPECT_EQ(directory.content(), Names{"report.xml"});
  const auto back = Teuchos::getParametersFromXmlFile(file.string());
  EXPECT_EQ(back->sublist("Iterations").get<int>("CG Steps"), 12);
  EXPECT_DOUBLE_EQ(back->sublist("Accuracy").get<double>("Energy"), -0.1179435511612625);
  EXPECT_EQ(back->sublist("Status").get<std::string>("Reason"), "‖g‖ < 1e-6 & done");
}

TEST_F(FilesTest, HistoryTableHasOneExactLineAStep) {
  const qp::History history{{0, 0, qp::StepKind::start, 1.0, 0.5, 0.0, 3, 1},
                            {1, 0, qp::StepKind::expansion, 0.1, 1e-300, -2.5, 4, 3}};
  const auto file = directory.path() / "history.csv";
  writeHistory(history, file, *comm);
  EXPECT_EQ(contentOf(file),
            "iteration,outer,step,projected_gradient,constraint_residual,objective,active_bounds,"
            "hessian_multiplications\n"
            "0,0,s,1,0.5,0,3,1\n"
            "1,0,e,0.1,1e-300,-2.5,4,3\n");
}

TEST(NamesTest, UnsafeCharactersAreReplacedAndNamesStayDifferent) {
  const std::vector<std::string> given{"left", "a b/c", "a_b_c", "..", "", "Körper"};
  const std::vector<std::string> expected{"left", "a_b_c", "a_b_c_2", "unnamed", "unnamed_2", "Körper"};
  EXPECT_EQ(safeNames(given), expected);
}

TEST(SlabTest, SharesFollowEachOtherAndDifferByAtMostOne) {
  const auto comm = Tpetra::getDefaultComm();
  for (const GlobalOrdinal rows : {0, 1, 2, 7, 12}) {
    const RowRange share = evenShare(rows, *comm);
    GlobalOrdinal upToHere = 0;
    Teuchos::scan(*comm, Teuchos::REDUCE_SUM, 1, &share.count, &upToHere);
    EXPECT_EQ(share.first + share.count, upToHere);
    EXPECT_GE(share.count, rows / comm->getSize());
    EXPECT_LE(share.count, rows / comm->getSize() + 1);
    GlobalOrdinal all = 0;
    Teuchos::reduceAll(*comm, Teuchos::REDUCE_SUM, 1, &share.count, &all);
    EXPECT_EQ(all, rows);
  }
}

} // namespace
} // namespace epafi::output
