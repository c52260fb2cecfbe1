// Checkpoints: the same file on any number of ranks, and a sentence for whatever else is given for one.

#include "SampleRun.hpp"
#include "support/TemporaryDirectory.hpp"

#include "support/OneRank.hpp"
#include "support/Refusal.hpp"

#include "epafi/base/Slab.hpp"
#include "epafi/output/Checkpoint.hpp"
#include "epafi/output/StepsText.hpp"

#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

namespace epafi::output {
namespace {

/// λ of row k.
double valueOf(GlobalOrdinal row) {
  return std::sqrt(2.0 + static_cast<double>(row)) - 2;
}

std::string bytesOf(double value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// A file's text with the checksum that belongs to it.
std::string sealed(const std::string& content) {
  Checksum checksum;
  checksum.add(content.data(), content.size());
  const std::uint64_t value = checksum.value();
  std::string seal(sizeof value, '\0');
  std::memcpy(seal.data(), &value, sizeof value);
  return content + seal;
}

class CheckpointTest : public testing::Test {
protected:
  RCP<const Comm> comm = Tpetra::getDefaultComm();
  test::TemporaryDirectory directory{comm};
  std::filesystem::path file = directory.path() / "checkpoint.epafi";
  model::Decomposition cut = model::decompose(test::sampleScene(), comm);
  Fingerprint fingerprint = fingerprintOf(cut.problem);
  const std::size_t stride =
      comm->getSize() == 1 ? 1 : 37; ///< from one place in a file to the next that is tried

  [[nodiscard]] RCP<Vector> multipliers() const {
    const RCP<Vector> lambda = rcp(new Vector(cut.problem.multiplierMap));
    for (GlobalOrdinal row = 0; row < fingerprint.numMultipliers(); ++row)
      if (cut.problem.multiplierMap->isNodeGlobalElement(row))
        lambda->replaceGlobalValue(row, valueOf(row));
    return lambda;
  }
  /// The file as this test understands it.
  [[nodiscard]] std::string expectedContent() const {
    std::string content = checkpointHeader(fingerprint);
    for (GlobalOrdinal row = 0; row < fingerprint.numMultipliers(); ++row)
      content += bytesOf(valueOf(row));
    return sealed(content);
  }
  [[nodiscard]] std::string content() const {
    comm->barrier();
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  const std::filesystem::path& put(const std::string& text) const {
    comm->barrier();
    if (comm->getRank() == 0)
      std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  /// What readCheckpoint says of a file with this content.
  [[nodiscard]] std::string refusalOf(const std::string& text) const {
    put(text);
    return ::epafi::test::refusal([&] { readCheckpoint(file, *comm); });
  }
  /// What multipliersOf says of a checkpoint of the sample scene given for a changed one.
  [[nodiscard]] std::string refusalFor(const std::function<void(scene::Scene&)>& change) const {
    writeCheckpoint(file, fingerprint, *multipliers());
    scene::Scene scene = test::sampleScene();
    change(scene);
    const auto other = model::decompose(scene, comm);
    const Checkpoint checkpoint = readCheckpoint(file, *comm);
    return ::epafi::test::refusal(
        [&] { static_cast<void>(multipliersOf(checkpoint, other.problem, fingerprintOf(other.problem))); });
  }
};

TEST_F(CheckpointTest, TheFileIsTheSameOnAnyNumberOfRanks) {
  writeCheckpoint(file, fingerprint, *multipliers());
  EXPECT_EQ(content(), expectedContent());
  EXPECT_EQ(directory.content(), std::set<std::string>{"checkpoint.epafi"});
}

TEST_F(CheckpointTest, WhatIsReadIsWhatWasWritten) {
  put(expectedContent());
  const RCP<Vector> lambda = multipliersOf(readCheckpoint(file, *comm), cut.problem, fingerprint);
  lambda->update(-1.0, *multipliers(), 1.0);
  EXPECT_EQ(lambda->normInf(), 0);
}

/// Two steps, with one of all there is.
simulation::StepsDone stepsDone() {
  simulation::StepsDone done;
  simulation::StepResult step;
  step.name = "pull, \n1";
  step.multiplications = 17;
  step.strainEnergy = 1.0 / 3;
  step.loadWork = -1e-300;
  step.reason = "the tolerance is reached";
  step.feedback = {0.25, 9};
  step.relativeError = 0.01;
  simulation::ContactResult contact;
  contact.name = "";
  contact.candidates = 12;
  contact.resultant = {0.1, -0.0, 1e99};
  contact.penetration = 1e-7;
  contact.balance = {"mortars", 1e-16, 2e-16};
  contact.friction.emplace().moment = {1, 2, 3};
  step.contacts = {contact, {}};
  step.supports = {{"body", "foot", {1, 2, 3}, {4, 5, 6}}};
  step.preloads = {{"bolt", 100, 0.1}};
  step.ties = {{"weld", 7, {1, 2, 3}, 0.5, "", {"mortars", 1e-16, 0}}};
  step.holds = {{"'pin' can turn", {0, -0.1, 0}, {1, 2, 3}}};
  step.doubts = "pins turn, \nperhaps";
  done.meshes = {0.1, -7e300};
  done.results = {step, {}};
  done.slip = {{0, 1, 77, {0.1, 0.2, 0.3}}, {1, 0, 3, {0, -1, 0}}};
  done.held = {{"body", "foot", {{5, {1, 2, 3}}, {9, {-1, 0.1, 0}}}}};
  done.marks = {0xffffffffffffffffULL, 0, 5};
  return done;
}

TEST_F(CheckpointTest, LoadStepsAreReadOnAllRanksAsTheyWereWritten) {
  const simulation::StepsDone written = stepsDone();
  writeCheckpoint(file, fingerprint, *multipliers(), &written);

  const Checkpoint checkpoint = readCheckpoint(file, *comm);

  ASSERT_TRUE(checkpoint.steps.has_value());
  const simulation::StepsDone& read = *checkpoint.steps;
  ASSERT_EQ(read.results.size(), 2U);
  const simulation::StepResult &step = read.results[0], &first = written.results[0];
  EXPECT_EQ(step.name, first.name);
  EXPECT_EQ(step.strainEnergy, first.strainEnergy);
  EXPECT_EQ(step.loadWork, first.loadWork);
  EXPECT_EQ(step.feedback->factor, 0.25);
  EXPECT_EQ(step.relativeError, 0.01);
  EXPECT_TRUE(std::isnan(read.results[1].relativeError));
  EXPECT_EQ(read.meshes, written.meshes);
  ASSERT_EQ(step.contacts.size(), 2U);
  EXPECT_EQ(step.contacts[0].resultant, first.contacts[0].resultant);
  EXPECT_EQ(step.contacts[0].penetration, first.contacts[0].penetration);
  EXPECT_EQ(step.contacts[0].balance->coupling, "mortars");
  EXPECT_EQ(step.contacts[0].friction->moment, first.contacts[0].friction->moment);
  EXPECT_FALSE(step.contacts[1].friction.has_value());
  EXPECT_EQ(step.supports[0].moment, first.supports[0].moment);
  EXPECT_EQ(step.preloads[0].shortening, 0.1);
  EXPECT_EQ(step.ties[0].resultant, first.ties[0].resultant);
  EXPECT_EQ(step.ties[0].balance.coupling, "mortars");
  EXPECT_EQ(step.holds[0].force, first.holds[0].force);
  EXPECT_EQ(step.doubts, first.doubts);
  EXPECT_EQ(read.slip[1].node, 3);
  EXPECT_EQ(read.slip[0].slip, written.slip[0].slip);
  EXPECT_EQ(read.held[0].displacements, written.held[0].displacements);
  EXPECT_EQ(read.marks, written.marks);
  EXPECT_EQ(stepsText(read), stepsText(written));
  EXPECT_FALSE(readCheckpoint(put(expectedContent()), *comm).steps.has_value());
}

TEST_F(CheckpointTest, StepsThatCannotBeReadAreRefusedWithARightChecksumToo) {
  const std::string text = stepsText(stepsDone());
  std::string values;
  for (GlobalOrdinal row = 0; row < fingerprint.numMultipliers(); ++row)
    values += bytesOf(valueOf(row));
  for (std::size_t length = 1; length < text.size(); length += 3 * stride)
    ::epafi::test::expectSays(
        refusalOf(sealed(checkpointHeader(fingerprint, length) + values + text.substr(0, length))),
        {file.string(), "load steps that cannot be read"});
  for (const std::string& other :
       {text + "1\n", std::string("99999999999999\n"), std::string("-1\n"), stepsText({})})
    ::epafi::test::expectSays(refusalOf(sealed(checkpointHeader(fingerprint, other.size()) + values + other)),
                              {"load steps that cannot be read"});
}

TEST_F(CheckpointTest, TheFingerprintDoesNotDependOnTheRanks) {
  const auto alone = model::decompose(test::sampleScene(), ::epafi::test::thisRankOnly());
  const Fingerprint same = fingerprintOf(alone.problem);
  EXPECT_EQ(differenceBetween(fingerprint, same), "");
  EXPECT_EQ(fingerprint.rows, same.rows);
  EXPECT_EQ(fingerprint.stiffness, same.stiffness);
}

TEST_F(CheckpointTest, LoadsGapsAndPrescribedValuesMayChange) {
  scene::Scene scene = test::sampleScene();
  scene.bodies[0].loads = {fem::loadInside("weight", mesh::rectangle(0, 1, 0, 1), -3.0)};
  scene.bodies[0].supports[0].value[0] = 0.5;
  scene.contacts[0].gap = 0.75;
  const auto other = model::decompose(scene, comm);
  EXPECT_EQ(differenceBetween(fingerprint, fingerprintOf(other.problem)), "");
}

TEST_F(CheckpointTest, AnotherProblemIsRefusedWithTheDifference) {
  const auto says = [&](const std::function<void(scene::Scene&)>& change, const char* difference) {
    ::epafi::test::expectSays(refusalFor(change), {file.string(), difference});
  };
  says(
      [](scene::Scene& scene) {
        scene.bodies[0].decomposition.counts = {4, 2};
      },
      "has 7 subdomains instead of 11");
  says([](scene::Scene& scene) { scene.bodies[0].mesh.elements = {6, 4, 0}; }, "primal unknowns");
  says([](scene::Scene& scene) { scene.bodies[1].decomposition.counts = {1, 3}; }, "instead of");
  says([](scene::Scene& scene) { scene.contacts.clear(); }, "multipliers of contact");
  says([](scene::Scene& scene) { scene.bodies[0].material.conductivity = 1.001; }, "stiffness");
  // As many rows of each kind, between other nodes.
  says(
      [](scene::Scene& scene) {
        std::swap(scene.bodies[0], scene.bodies[1]);
        std::swap(scene.contacts[0].first, scene.contacts[0].second);
      },
      "joins other nodes");
}

TEST_F(CheckpointTest, WhatIsNoCheckpointIsRefused) {
  using ::epafi::test::expectSays;
  expectSays(::epafi::test::refusal([&] { readCheckpoint(directory.path() / "none", *comm); }),
             {"none", "exist"});
  expectSays(::epafi::test::refusal([&] { readCheckpoint(directory.path(), *comm); }), {"no regular file"});
  expectSays(refusalOf(""), {file.string(), "no checkpoint of Epafi"});
  expectSays(refusalOf("\x89HDF\r\n\x1a\n and so on"), {"no checkpoint of Epafi"});
  expectSays(refusalOf(std::string(100000, 'x')), {"no checkpoint of Epafi"});
  expectSays(refusalOf("Epafi checkpoint 1\n"), {"another version"});
  expectSays(refusalOf("Epafi checkpoint 4\norder middle\n"), {"another order"});
}

/// Else fuzzing would begin, and end, at the first line.
TEST_F(CheckpointTest, FilesOfTheFuzzersCorpusAreOfThisVersion) {
  const auto corpus = std::filesystem::path(EPAFI_SOURCE_DIR) / "test/fuzz/corpus/checkpoint";
  for (const char* name : {"none", "steps", "three-multipliers"})
    EXPECT_NO_THROW(readCheckpoint(corpus / name, *comm)) << name;
}

TEST_F(CheckpointTest, AFileCutOffAnywhereIsRefused) {
  const std::string whole = expectedContent();
  for (std::size_t length = 0; length < whole.size(); length += stride)
    EXPECT_NE(refusalOf(whole.substr(0, length)), "") << length;
  ::epafi::test::expectSays(refusalOf(whole.substr(0, whole.size() - 1)), {"cut off"});
  ::epafi::test::expectSays(refusalOf(whole + "x"), {"added"});
}

TEST_F(CheckpointTest, AChangedByteAnywhereIsNoticed) {
  const std::string whole = expectedContent();
  for (std::size_t place = 0; place < whole.size(); place += stride) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 4);
    EXPECT_NE(refusalOf(damaged), "") << place;
  }
  std::string damaged = whole;
  damaged[whole.size() - 20] = static_cast<char>(damaged[whole.size() - 20] ^ 1);
  ::epafi::test::expectSays(refusalOf(damaged), {"checksum"});
}

TEST_F(CheckpointTest, NumbersThatAreNotFiniteAreRefusedWhicheverRankGetsThem) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()})
    for (const GlobalOrdinal place : {GlobalOrdinal{0}, fingerprint.numMultipliers() - 1}) {
      std::string text = checkpointHeader(fingerprint);
      for (GlobalOrdinal row = 0; row < fingerprint.numMultipliers(); ++row)
        text += bytesOf(row == place ? bad : valueOf(row));
      ::epafi::test::expectSays(refusalOf(sealed(text)), {file.string(), "not finite"});
    }
}

TEST_F(CheckpointTest, ClaimsOfAHeadAreNotBelieved) {
  for (const GlobalOrdinal many : {GlobalOrdinal{1} << 20, GlobalOrdinal{1} << 50}) {
    Fingerprint huge = fingerprint;
    huge.numEqualities = many;
    ::epafi::test::expectSays(refusalOf(sealed(checkpointHeader(huge))),
                              {"cut off"}); // and no memory asked for
  }
  Fingerprint negative = fingerprint;
  negative.numEqualities = -5;
  ::epafi::test::expectSays(refusalOf(sealed(checkpointHeader(negative))), {"equalities"});
  Fingerprint nothing = fingerprint;
  nothing.stiffness = std::numeric_limits<double>::quiet_NaN();
  ::epafi::test::expectSays(refusalOf(sealed(checkpointHeader(nothing))), {"stiffness"});
}

TEST_F(CheckpointTest, AFullDiskLeavesTheOlderFile) {
  put("older");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{200, before.rlim_max};
  comm->barrier();
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    writeCheckpoint(file, fingerprint, *multipliers());
    ADD_FAILURE() << "written on rank " << comm->getRank();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(content(), "older");
  EXPECT_EQ(directory.content(), std::set<std::string>{"checkpoint.epafi"});
}

} // namespace
} // namespace epafi::output
