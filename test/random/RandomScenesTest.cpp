// Verdicts, energies, forces and displacements of random scenes beside an exact reference.
// EPAFI_RANDOM_SCENES is their number, 60 if not given; EPAFI_RANDOM_FIRST the first of them;
// EPAFI_RANDOM_SEED runs one alone, and EPAFI_RANDOM_FOLDER keeps its files.

#include "Cones.hpp"
#include "RandomNumbers.hpp"
#include "SceneOutcome.hpp"
#include "support/MeshFiles.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Tpetra_Core.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace epafi::test {
namespace {

std::uint64_t numberFrom(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// A crash tells in which scene it was.
std::uint64_t running = 0;
extern "C" void tellSeed(int signal) {
  std::fprintf(stderr, "crash in the scene of EPAFI_RANDOM_SEED=%llu\n",
               static_cast<unsigned long long>(running));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// What rank 0 says is true on all.
bool told(const Comm& comm, bool value) {
  int number = value ? 1 : 0;
  Teuchos::broadcast(comm, 0, &number);
  return number != 0;
}

/// The ranks of one scene, and the others, which have none.
RCP<const Comm> firstRanks(const Comm& comm, int count) {
  return comm.split(comm.getRank() < count ? 0 : -1, comm.getRank());
}

/// A scene with what is true of it, on rank 0.
struct Case {
  std::uint64_t seed;
  DrawnScene scene;
  Truth truth;
};

/// Nothing if neither verdict is certain. Collective.
std::optional<Case> caseOf(std::uint64_t seed, const Comm& comm, const std::string& folder) {
  Case result{seed, drawnScene(seed, comm.getSize()), {}};
  bool isCertain = true;
  if (comm.getRank() == 0)
    try {
      result.truth = truthOf(sceneOf(listOf(result.scene, folder), folder));
    } catch (const Uncertain& uncertain) {
      isCertain = false;
      if (std::getenv("EPAFI_RANDOM_SEED") != nullptr)
        std::printf("not certain: %s\n", uncertain.of);
    } catch (const InputError& error) {
      result.truth = {Verdict::wrongInput, error.what()};
    } catch (const SolvabilityError& error) {
      result.truth = {Verdict::contradiction, error.what()};
    }
  if (!told(comm, isCertain))
    return std::nullopt;
  return result;
}

/// Many products where the defaults take few. Collective over `ranks`.
std::string slowness(Teuchos::ParameterList list, const Outcome& outcome, const std::string& folder,
                     const RCP<const Comm>& ranks) {
  constexpr int many = 500, few = 100;
  if (outcome.products <= many)
    return "";
  Teuchos::ParameterList defaults("Solver");
  for (const char* const tolerance : {"Tolerance", "Equilibrium Tolerance"})
    defaults.set(tolerance, list.sublist("Solver").get<double>(tolerance));
  list.set("Solver", defaults);
  const int products = outcomeOf(list, folder, ranks).products;
  return products < few
             ? std::to_string(outcome.products) + " products for " + std::to_string(products) + "; "
             : "";
}

/// Solves a scene, or a copy of one, and says on rank 0 what is wrong with the answer. Collective.
std::string faultOf(const DrawnScene& scene, const Truth& truth, const Comm& comm, const std::string& folder,
                    bool withPlaces) {
  const RCP<const Comm> ranks = firstRanks(comm, scene.ranks);
  if (ranks.is_null())
    return "";
  Teuchos::ParameterList list = listOf(scene, folder);
  Outcome outcome = outcomeOf(list, folder, ranks);
  if (outcome.reason.find("is a cluster of its own and has too few nodes") != std::string::npos) {
    for (const auto& body : list.sublist("Bodies")) // as the message advises
      list.sublist("Bodies").sublist(body.first).sublist("Decomposition").set("Cluster", 0);
    outcome = outcomeOf(list, folder, ranks);
  }
  if (comm.getRank() == 0 && std::getenv("EPAFI_RANDOM_FOLDER") != nullptr)
    Teuchos::writeParameterListToXmlFile(list, folder + "/scene.xml");
  const std::string slow = slowness(list, outcome, folder, ranks);
  if (comm.getRank() > 0)
    return "";
  if (std::getenv("EPAFI_RANDOM_SEED") != nullptr)
    std::printf("%s, %s; for %s %s\nenergy %.12g for %.12g, force %.12g for %.12g, %d products, %d ranks\n",
                toString(outcome.verdict).c_str(), outcome.reason.c_str(), toString(truth.verdict).c_str(),
                truth.reason.c_str(), outcome.energy, truth.energy, outcome.force, truth.force,
                outcome.products, scene.ranks);
  return slow + test::faultOf(outcome, truth, withPlaces);
}

/// What is true of the scene in other units, places apart.
Truth inUnits(Truth truth, const Units& units, int dimension) {
  const double force = units.stiffness * units.load * std::pow(units.length, dimension - 1);
  truth.force *= force;
  truth.forceScale *= force;
  truth.energy *= force * units.load * units.length;
  truth.energyScale *= force * units.load * units.length;
  return truth;
}

std::string toString(const Units& units) {
  std::ostringstream text;
  text << "lengths by " << units.length << ", stiffness by " << units.stiffness << ", loads by "
       << units.load;
  return text.str();
}

/// Whether twice the loads, gaps and prescribed displacements are twice the answer: no gap comes from shapes.
bool isLinear(const DrawnScene& scene) {
  return std::all_of(scene.contacts.begin(), scene.contacts.end(), [](const DrawnContact& contact) {
    return contact.second >= 0 || (contact.radius == 0 && contact.normal.cwiseAbs().sum() == 1);
  });
}

class RandomScenesTest : public testing::Test {
protected:
  RCP<const Comm> comm_ = Tpetra::getDefaultComm();
  epafi::test::MeshFolder temporary_;
  std::string folder_ = temporary_.path("");

  void SetUp() override {
    std::signal(SIGSEGV, tellSeed);
    std::signal(SIGABRT, tellSeed);
    if (const char* const given = std::getenv("EPAFI_RANDOM_FOLDER")) {
      folder_ = given;
      std::filesystem::create_directories(folder_);
    }
  }

  /// Calls `check` with a number of scenes, those whose verdict is uncertain being drawn anew.
  template <class Check>
  void forScenes(std::uint64_t count, const Check& check) {
    constexpr std::uint64_t attempts = 100;
    if (const std::uint64_t alone = numberFrom("EPAFI_RANDOM_SEED", 0)) {
      running = alone;
      if (const auto drawn = caseOf(alone, *comm_, folder_))
        check(*drawn);
      return;
    }
    const std::uint64_t first = numberFrom("EPAFI_RANDOM_FIRST", 0);
    for (std::uint64_t number = first; number < first + count; ++number)
      for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
        running = attempts * number + attempt + 1;
        if (const auto drawn = caseOf(running, *comm_, folder_)) {
          check(*drawn);
          break;
        }
      }
  }

  /// What rank 0 finds wrong is wrong.
  void expectRight(const Case& drawn, const DrawnScene& copy, const Truth& truth, const std::string& what) {
    const std::string fault = faultOf(copy, truth, *comm_, folder_, what.empty());
    if (!fault.empty())
      ADD_FAILURE() << "EPAFI_RANDOM_SEED=" << drawn.seed << ' ' << what << ": " << fault;
  }
};

TEST_F(RandomScenesTest, AreSolvedOrRefusedRightly) {
  std::map<Verdict, int> verdicts;
  forScenes(numberFrom("EPAFI_RANDOM_SCENES", 60), [&](const Case& drawn) {
    ++verdicts[drawn.truth.verdict];
    expectRight(drawn, drawn.scene, drawn.truth, "");
  });
  for (const auto& [verdict, count] : verdicts)
    if (comm_->getRank() == 0)
      std::printf("%d %s\n", count, toString(verdict).c_str());
}

/// Where round-off leaves no solution in balance, none is claimed.
TEST_F(RandomScenesTest, ThatRoundOffLeavesOpenSaySo) {
  for (const std::uint64_t seed : {150401, 1008601})
    if (const auto drawn = caseOf(seed, *comm_, folder_))
      for (int copy = 0; copy < 3; ++copy) {
        DrawnScene other = drawn->scene;
        if (copy > 0) {
          drawCuts(other, seed + 10 * static_cast<std::uint64_t>(copy) - 6);
          drawSolver(other, seed + 10 * static_cast<std::uint64_t>(copy) - 5);
        }
        other.ranks = 1;
        const std::string fault = faultOf(other, drawn->truth, *comm_, folder_, true);
        EXPECT_TRUE(fault.empty() || fault.find("not converged") != std::string::npos)
            << seed << ", copy " << copy << ": " << fault;
      }
}

TEST_F(RandomScenesTest, HaveTheSameAnswerInOtherUnits) {
  forScenes(numberFrom("EPAFI_RANDOM_SCENES", 60) / 6, [&](const Case& drawn) {
    std::vector<Units> all{{1e9, 1, 1}, {1e-9, 1, 1}, {1, 1e9, 1}, {1, 1e-9, 1}};
    if (isLinear(drawn.scene))
      all.insert(all.end(), {{1, 1, 1e6}, {1, 1, drawn.scene.turn.isIdentity(0) ? 1e-6 : 1e-3}});
    for (const Units& units : all)
      expectRight(drawn, inUnits(drawn.scene, units), inUnits(drawn.truth, units, drawn.scene.dimension),
                  toString(units));
  });
}

TEST_F(RandomScenesTest, HaveTheSameAnswerInOtherPlacesAndCuts) {
  forScenes(numberFrom("EPAFI_RANDOM_SCENES", 60) / 6, [&](const Case& drawn) {
    RandomNumbers random(drawn.seed + 3);
    for (int copy = 0; copy < 3; ++copy) {
      DrawnScene other = drawn.scene;
      if (other.canTurn())
        other = movedTo(std::move(other), random.uniform(0, 6.28), random.uniform(0, 20));
      drawCuts(other, drawn.seed + 10 * static_cast<std::uint64_t>(copy) + 4);
      drawSolver(other, drawn.seed + 10 * static_cast<std::uint64_t>(copy) + 5);
      other.ranks = 1 + random.index(comm_->getSize());
      expectRight(drawn, other, drawn.truth, "copy " + std::to_string(copy));
    }
  });
}

} // namespace
} // namespace epafi::test
