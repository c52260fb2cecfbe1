#include "Arrays.hpp"
#include "Doors.hpp"
#include "Task.hpp"
#include "UndecomposedSystem.hpp"

#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/ParameterOverride.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <pybind11/stl.h>

namespace epafi::python {
namespace {

template <class Numbers>
auto copied(const Numbers& numbers) {
  return arrayOf(std::vector<typename Numbers::value_type>(numbers.data(), numbers.data() + numbers.size()));
}

/// indptr, indices, data and the shape.
py::tuple rowsOf(const drivers::UndecomposedSystem::Matrix& matrix) {
  const auto part = [](const auto* begin, Eigen::Index count) {
    return arrayOf(std::vector(begin, begin + count));
  };
  return py::make_tuple(
      part(matrix.outerIndexPtr(), matrix.rows() + 1), part(matrix.innerIndexPtr(), matrix.nonZeros()),
      part(matrix.valuePtr(), matrix.nonZeros()), py::make_tuple(matrix.rows(), matrix.cols()));
}

py::array_t<double> pointsOf(const Eigen::Matrix3Xd& points) {
  return arrayOf(std::vector<double>(points.data(), points.data() + points.size()), 3);
}

/// \param text, file, overrides  as solveScene has them; load steps are left out
py::dict systemOf(const std::string& text, const std::string& file,
                  const std::vector<std::string>& overrides) {
  drivers::UndecomposedSystem system;
  drivers::Task task;
  {
    const py::gil_scoped_release noLock;
    Teuchos::ParameterList given = text.empty() ? scene::readParameterFile(file, Teuchos::SerialComm<int>())
                                                : scene::parseParameters(text, file);
    for (const std::string& assignment : overrides)
      scene::applyOverride(given, simulation::driverSchema(), assignment);
    task = drivers::readTask(given, file);
    system = drivers::undecomposedSystem(task.scene);
  }
  std::vector<std::string> bodies;
  for (const scene::Body& body : task.scene.bodies)
    bodies.push_back(body.name);
  using namespace py::literals;
  return py::dict("stiffness"_a = rowsOf(system.stiffness), "load"_a = copied(system.load),
                  "constraint"_a = rowsOf(system.constraint), "gap"_a = copied(system.gap),
                  "contacts"_a = system.numContacts, "energy_offset"_a = system.energyOffset,
                  "tangent"_a = rowsOf(system.tangent), "tangent_gap"_a = copied(system.tangentGap),
                  "friction_row"_a = copied(system.frictionRow), "friction"_a = copied(system.friction),
                  "friction_bound"_a = copied(system.frictionBound), "bodies"_a = bodies,
                  "body"_a = copied(system.body), "node"_a = copied(system.node),
                  "place"_a = pointsOf(system.place), "direction"_a = pointsOf(system.direction),
                  "components"_a = system.components);
}

} // namespace

void defineSystems(py::module_& module) {
  module.def("system_of", &systemOf);
}

} // namespace epafi::python
