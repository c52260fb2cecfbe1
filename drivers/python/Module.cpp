/// The module epafi._epafi: what the package epafi is made of.

#include "Arrays.hpp"
#include "Doors.hpp"
#include "JointEnd.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/HeldSignal.hpp"
#include "epafi/base/PeakMemory.hpp"
#include "epafi/base/Version.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <Tpetra_Core.hpp>

#include <array>
#include <csignal>
#include <string>

namespace epafi::python {
namespace {

/// Before MPI starts, whoever starts it.
void prepare() {
  keepFreedMemory();
  int hasMpi = 0;
  MPI_Initialized(&hasMpi);
  if (hasMpi == 0)
    drivers::startLean();
}

/// MPI, unless mpi4py has started it, and Kokkos. Both end when Python has destroyed all objects.
void begin() {
  if (Tpetra::isInitialized())
    return;
  const HeldSignal held(SIGTERM); // as drivers::runMain has it
  std::string name = "epafi";
  std::array<char*, 2> words{name.data(), nullptr};
  int numWords = 1;
  char** all = words.data();
  Tpetra::initialize(&numWords, &all);
  Py_AtExit([] { Tpetra::finalize(); });
}

} // namespace

PYBIND11_MODULE(_epafi, module) {
  const auto error = py::register_exception<Error>(module, "Error");
  py::register_exception<InputError>(module, "InputError",
                                     py::make_tuple(error, py::handle(PyExc_ValueError)));
  py::register_exception<SolvabilityError>(module, "SolvabilityError", error);
  module.attr("version") = version();
  module.def("prepare", &prepare);
  module.def("begin", &begin);
  module.def("schema", [] { return schemaOf(simulation::driverSchema()); });
  defineScenes(module);
  definePrograms(module);
  defineMatrices(module);
  defineSurfaces(module);
  defineSystems(module);
}

} // namespace epafi::python
