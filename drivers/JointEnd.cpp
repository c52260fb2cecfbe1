#include "JointEnd.hpp"

#include "epafi/base/PeakMemory.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/HeldSignal.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_Time.hpp>
#include <Tpetra_Core.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

namespace epafi::drivers {
namespace {

struct Failure {
  ExitCode code = notConverged;
  std::string sentence;
  std::string program;
};

void say(const Failure& failure, const std::string& sentence) {
  std::cerr << failure.program + ": " + sentence + '\n' << std::flush;
}

/// Whether `isDone` comes true within so many seconds.
template <class Condition>
bool awaited(double seconds, const Condition& isDone) {
  const double end = Teuchos::Time::wallTime() + seconds;
  while (!isDone()) {
    if (Teuchos::Time::wallTime() > end)
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// After some ranks failed and others did not. Does not return where there is MPI.
void endForAll(MPI_Comm messages, int rank, int size, const Failure& failure) {
  constexpr double hearing = 0.5; // seconds in which the others that failed are heard
  MPI_Request request = MPI_REQUEST_NULL;
  for (int other = rank + 1; other < size; ++other)
    MPI_Isend(nullptr, 0, MPI_BYTE, other, 0, messages, &request); // "I speak"
  const bool anotherSpeaks = awaited(hearing, [&] {
    int isThere = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, messages, &isThere, MPI_STATUS_IGNORE);
    return isThere != 0;
  });
  if (anotherSpeaks)
    std::this_thread::sleep_for(std::chrono::seconds(2)); // until its MPI_Abort comes
  else
    say(failure, failure.sentence.starts_with("rank ")
                     ? failure.sentence
                     : "rank " + std::to_string(rank) + " failed: " + failure.sentence);
  MPI_Abort(MPI_COMM_WORLD, failure.code);
}

int endAfter(const Failure& failure, const Comm& comm, MPI_Comm messages, double patience) {
  const int rank = comm.getRank(), size = comm.getSize();
  int code = failure.code;
  if (size > 1) {
    MPI_Request agreement = MPI_REQUEST_NULL;
    MPI_Iallreduce(&failure.code, &code, 1, MPI_INT, MPI_MAX, messages, &agreement);
    const bool allFailed = awaited(patience, [&] {
      int isDone = 0;
      MPI_Test(&agreement, &isDone, MPI_STATUS_IGNORE);
      return isDone != 0;
    });
    if (!allFailed)
      endForAll(messages, rank, size, failure);
  }
  if (rank == 0)
    say(failure, failure.sentence);
  return code;
}

} // namespace

int endTogether(const Comm& comm, const std::function<int()>& work, double patience,
                const std::string& program) {
  MPI_Comm messages = MPI_COMM_NULL;
  if (const auto* mpi = dynamic_cast<const Teuchos::MpiComm<int>*>(&comm))
    MPI_Comm_dup(*mpi->getRawMpiComm(), &messages);
  Failure failure;
  try {
    return work();
  } catch (const InputError& error) {
    failure = {wrongInput, error.what(), program};
  } catch (const SolvabilityError& error) {
    failure = {notSolvable, error.what(), program};
  } catch (const std::exception& error) {
    failure = {notConverged, sentenceOf(error, comm.getRank()), program};
  } catch (...) {
    failure = {notConverged, "an unknown error occurred", program};
  }
  return endAfter(failure, comm, messages, patience);
}

void startLean() {
  for (const char* ofLaunchers : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_FD", "PMI_PORT",
                                  "SLURM_PROCID", "MPI_LOCALRANKID", "FLUX_JOB_ID", "ALPS_APP_PE"})
    if (std::getenv(ofLaunchers) != nullptr)
      return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("OMPI_MCA_sharedfp", "^sm", 0); // whose file would be there
  setenv("OMPI_MCA_pml", "ob1", 0);
  setenv("HWLOC_COMPONENTS", "-gl", 0);
}

int runMain(int argc, char** argv, const std::string& program,
            const std::function<int(const RCP<const Comm>&)>& work) {
  keepFreedMemory();
  startLean();
  int programNameOnly = std::min(argc, 1); // Kokkos would answer --help itself
  const Tpetra::ScopeGuard scope = [&] {
    const HeldSignal held(SIGTERM); // from the threads that MPI starts: METIS must be able to hold it
    return Tpetra::ScopeGuard(&programNameOnly, &argv);
  }();
  const RCP<const Comm> comm = Tpetra::getDefaultComm();
  return endTogether(
      *comm, [&] { return work(comm); }, 3.0, program);
}

} // namespace epafi::drivers
