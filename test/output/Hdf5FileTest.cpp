// The HDF5 file that all ranks write together, read back by rank-local HDF5.

#include "Hdf5Reading.hpp"
#include "support/TemporaryDirectory.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/output/Hdf5File.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <numeric>

namespace epafi::output {
namespace {

/// All rows on rank 0.
RowRange onFirstRank(GlobalOrdinal rows, const Comm& comm) {
  return {0, comm.getRank() == 0 ? rows : 0};
}

using Names = std::set<std::string>;

struct Hdf5FileTest : testing::Test {
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};
  std::filesystem::path path = directory.path() / "fields.h5";

  /// Writes rows 0 … rows − 1 with the value 10 row + column.
  template <class T>
  void writeTable(Hdf5File& file, const std::string& name, GlobalOrdinal rows, int columns,
                  const RowRange& range) const {
    std::vector<T> values;
    for (GlobalOrdinal row = range.first; row < range.first + range.count; ++row)
      for (int column = 0; column < std::max(columns, 1); ++column)
        values.push_back(static_cast<T>(10 * row + column));
    file.write(name, rows, columns, range, std::span<const T>(values));
  }
};

TEST_F(Hdf5FileTest, TablesOfEveryTypeReadBackWhole) {
  Hdf5File file(path, comm);
  file.createGroup("/a/b");
  writeTable<double>(file, "/a/b/reals", 11, 3, evenShare(11, *comm));
  writeTable<int>(file, "/a/integers", 5, 0, evenShare(5, *comm));
  writeTable<long long>(file, "/long", 2, 2, evenShare(2, *comm));
  writeTable<signed char>(file, "/made/on/the/way", 4, 0, onFirstRank(4, *comm));
  writeTable<double>(file, "/empty", 0, 3, evenShare(0, *comm));
  file.attribute("/a/b", "name", std::string("left body"));
  file.attribute("/", "energy", -1.5);
  file.attribute("/", "format", 1LL);
  file.close();

  EXPECT_EQ(directory.content(), Names{"fields.h5"});
  const test::Table reals = test::readTable(path, "/a/b/reals");
  EXPECT_EQ(reals.extent, (std::vector<std::size_t>{11, 3}));
  EXPECT_EQ(reals.values[3 * 7 + 2], 72);
  EXPECT_EQ(test::readTable(path, "/a/integers").values, (std::vector<double>{0, 10, 20, 30, 40}));
  EXPECT_EQ(test::readTable(path, "/long").values, (std::vector<double>{0, 1, 10, 11}));
  EXPECT_EQ(test::readTable(path, "/made/on/the/way").values, (std::vector<double>{0, 10, 20, 30}));
  EXPECT_EQ(test::readTable(path, "/empty").extent, (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(test::readText(path, "/a/b", "name"), "left body");
}

TEST_F(Hdf5FileTest, RanksMayHoldNothingOrEverything) {
  const int last = comm->getSize() - 1;
  Hdf5File file(path, comm);
  writeTable<double>(file, "/x", 6, 0, comm->getRank() == last ? RowRange{0, 6} : RowRange{6, 0});
  file.close();
  EXPECT_EQ(test::readTable(path, "/x").values, (std::vector<double>{0, 10, 20, 30, 40, 50}));
}

TEST_F(Hdf5FileTest, NothingAppearsBeforeCloseAndNothingIsLeftWithoutIt) {
  {
    Hdf5File file(path, comm);
    writeTable<double>(file, "/x", 3, 0, evenShare(3, *comm));
    EXPECT_EQ(directory.content().count("fields.h5"), 0U);
    EXPECT_EQ(directory.content().size(), 1U);
  }
  EXPECT_EQ(directory.content(), Names{});
}

TEST_F(Hdf5FileTest, AbandonedFileLeavesTheOlderOne) {
  Hdf5File first(path, comm);
  writeTable<int>(first, "/x", 1, 0, onFirstRank(1, *comm));
  first.close();
  { Hdf5File second(path, comm); }
  EXPECT_EQ(test::readTable(path, "/x").values, std::vector<double>{0});
  Hdf5File third(path, comm);
  writeTable<int>(third, "/x", 2, 0, onFirstRank(2, *comm));
  third.close();
  EXPECT_EQ(test::readTable(path, "/x").values.size(), 2U);
  EXPECT_EQ(directory.content(), Names{"fields.h5"});
}

TEST_F(Hdf5FileTest, OfAGroupOnlyTheNamesThatAreWantedStay) {
  Hdf5File first(path, comm);
  for (const char* const name : {"/steps/a/x", "/steps/b/x", "/steps/c/x"})
    writeTable<int>(first, name, 2, 0, evenShare(2, *comm));
  first.link("/x", "/steps/c/x");
  first.close();
  const std::filesystem::path other = directory.path() / "other.h5";
  Hdf5File second(other, comm, path);
  second.removeAllBut("/steps", {"b", "d"});
  EXPECT_THROW(second.link("/y", "/steps/a/x"), Error);
  EXPECT_THROW(second.removeAllBut("/none", {}), Error);
  second.link("/x", "/steps/b/x");
  second.close();
  EXPECT_EQ(directory.content(), (Names{"fields.h5", "other.h5"}));
  EXPECT_EQ(test::readTable(other, "/steps/b/x").values, (std::vector<double>{0, 10}));
  EXPECT_EQ(test::readTable(path, "/steps/c/x").values, (std::vector<double>{0, 10}));
}

TEST_F(Hdf5FileTest, AFileGoesOnWithAllThatTheOlderOneHas) {
  Hdf5File first(path, comm);
  writeTable<int>(first, "/steps/a/x", 2, 0, evenShare(2, *comm));
  first.link("/x", "/steps/a/x");
  first.attribute("/", "name", std::string("a"));
  first.close();
  {
    Hdf5File second(path, comm, path);
    writeTable<int>(second, "/steps/b/x", 3, 0, evenShare(3, *comm));
    second.link("/x", "/steps/b/x");
    second.attribute("/", "name", std::string("longer"));
    EXPECT_THROW(second.link("/y", "/steps/c/x"), Error);
    EXPECT_EQ(test::readTable(path, "/x").values.size(), 2U); // until it is complete
    second.close();
  }
  EXPECT_EQ(directory.content(), Names{"fields.h5"});
  EXPECT_EQ(test::readTable(path, "/steps/a/x").values, (std::vector<double>{0, 10}));
  EXPECT_EQ(test::readTable(path, "/x").values, (std::vector<double>{0, 10, 20}));
  EXPECT_EQ(test::readText(path, "/", "name"), "longer");
  EXPECT_THROW(Hdf5File(directory.path() / "none.h5", comm, directory.path() / "none.h5"), Error);
  EXPECT_EQ(directory.content(), Names{"fields.h5"});
}

TEST_F(Hdf5FileTest, WrongSlabOnOneRankIsAnErrorOnAll) {
  Hdf5File file(path, comm);
  RowRange range = evenShare(8, *comm);
  const std::vector<double> tooShort(static_cast<std::size_t>(range.count) - (comm->getRank() == 0 ? 1 : 0));
  EXPECT_THROW(file.write("/x", 8, 0, range, std::span<const double>(tooShort)), Error);
  EXPECT_THROW(writeTable<double>(file, "/y", 9, 0, range), Error); // a row is missing
  writeTable<double>(file, "/z", 8, 0, range);                      // the file is still good
  file.close();
  EXPECT_EQ(test::readTable(path, "/z").values.size(), 8U);
}

TEST_F(Hdf5FileTest, AnExceptionOnOneRankAloneGetsOutOfItsScope) {
  const bool isFirst = comm->getRank() == comm->getSize() - 1;
  try {
    Hdf5File file(path, comm);
    writeTable<double>(file, "/x", 3, 0, evenShare(3, *comm));
    if (!isFirst)
      comm->barrier(); // whoever throws first must get to the other end of this without the others
    throw std::bad_alloc();
  } catch (const std::bad_alloc&) {
    if (isFirst)
      comm->barrier();
  }
  EXPECT_EQ(directory.content(), Names{});
}

TEST_F(Hdf5FileTest, ErrorsNameTheFileAndGiveHdf5sReason) {
  Hdf5File file(path, comm);
  file.createGroup("/a");
  try {
    file.createGroup("/a");
    FAIL() << "a group was made twice";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(path.string()), std::string::npos) << text;
    EXPECT_NE(text.find("exists"), std::string::npos) << text;
  }
}

/// Lets no file grow beyond a size, as a full disk would, for as long as it lives.
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST_F(Hdf5FileTest, FullDiskLeavesNoFile) {
  const auto writeMuch = [&] {
    Hdf5File file(path, comm);
    writeTable<double>(file, "/x", 300000, 0, evenShare(300000, *comm));
    file.close();
  };
  {
    const FullDisk full(100000);
    EXPECT_THROW(writeMuch(), Error);
    comm->barrier();
  }
  EXPECT_EQ(directory.content(), Names{});
}

} // namespace
} // namespace epafi::output
