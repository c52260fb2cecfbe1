#include "Arrays.hpp"
#include "Doors.hpp"
#include "FoundPairs.hpp"
#include "Summary.hpp"
#include "Task.hpp"
#include "Watch.hpp"

#include "epafi/assembly/AssemblySchema.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/output/BodyFields.hpp"
#include "epafi/output/ContactFields.hpp"
#include "epafi/output/FieldWriter.hpp"
#include "epafi/output/Report.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/ParameterOverride.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace epafi::python {
namespace {

/// The fields of a stage, of this rank's slabs, with what else their arrays are to say.
struct Fields {
  std::vector<output::BodyFields> bodies;
  std::vector<output::ContactFields> contacts;
  std::vector<simulation::TieFields> ties;
  simulation::Evaluation evaluation;
  simulation::RunResult result; ///< of the stage
};

/// Collective.
Fields fieldsOf(const simulation::SceneRun& run) {
  Fields fields{.bodies = {}, .contacts = {}, .ties = {}, .evaluation = run.evaluation, .result = run.result};
  const simulation::SolvedScene solved = run.solved();
  for (int b = 0; b < std::ssize(run.decomposition->bodies); ++b)
    fields.bodies.push_back(output::gatherBodyFields(solved, b));
  for (int c = 0; c < std::ssize(run.decomposition->contacts); ++c)
    fields.contacts.push_back(output::gatherContactFields(solved, c, run.evaluation.contacts[c]));
  for (const contact::ContactLayout& tie : run.decomposition->ties)
    fields.ties.push_back(simulation::gatherTieFields(solved, tie));
  return fields;
}

py::dict bodyOf(output::BodyFields& body, const scene::Body& scene, Fields& fields, int number) {
  py::dict dict;
  dict["physics"] = toString(scene.physics);
  dict["cell_type"] = std::string(mesh::toString(body.cellType));
  dict["points"] = arrayOf(std::move(body.points), 3);
  const auto components = body.nodes.count > 0 ? std::ssize(body.u) / body.nodes.count : 1;
  dict["u"] = arrayOf(std::move(body.u), static_cast<int>(components));
  dict["cells"] = arrayOf(std::move(body.corners), numNodesOf(body.cellType));
  dict["subdomain"] = arrayOf(std::move(body.subdomain));
  dict["von_mises"] = scene.physics == fem::Physics::membrane
                          ? py::object(py::none())
                          : arrayOf(std::move(fields.evaluation.vonMises[number]));
  dict["error"] = fields.evaluation.hasErrors
                      ? py::object(arrayOf(std::move(fields.evaluation.errors[number])))
                      : py::none();
  return dict;
}

py::dict contactOf(output::ContactFields& contact) {
  py::dict dict;
  dict["cell_type"] = contact.facetType ? std::string(mesh::toString(*contact.facetType)) : "vertex";
  dict["points"] = arrayOf(std::move(contact.points), 3);
  dict["normal"] = arrayOf(std::move(contact.normals), 3);
  dict["cells"] = arrayOf(std::move(contact.corners), contact.nodesPerFacet());
  dict["area"] = arrayOf(std::move(contact.areas));
  dict["initial_gap"] = arrayOf(std::move(contact.initialGap));
  dict["gap"] = arrayOf(std::move(contact.gap));
  dict["multiplier"] = arrayOf(std::move(contact.multiplier));
  dict["force"] = arrayOf(std::move(contact.force));
  dict["pressure"] = arrayOf(std::move(contact.pressure));
  dict["active"] = arrayOf(std::move(contact.active)).attr("astype")("bool");
  if (contact.friction) {
    dict["traction"] = arrayOf(std::move(contact.friction->traction), 3);
    dict["slip"] = arrayOf(std::move(contact.friction->slip), 3);
    dict["friction_state"] = arrayOf(std::move(contact.friction->state));
  }
  return dict;
}

/// A solved scene. Its factors and matrices are gone.
class Run {
public:
  Run(simulation::SceneRun run, std::vector<Fields> stages, RCP<const Comm> comm)
      : run_(std::move(run)), stages_(std::move(stages)), comm_(std::move(comm)),
        history_(run_.solver->report().history) {
    run_.solver.reset();
    for (decomposition::Subdomain& subdomain : run_.decomposition->problem.subdomains)
      subdomain.stiffness.reset();
  }

  [[nodiscard]] const simulation::RunResult& result() const { return run_.result; }

  /// The fields of each load step, of a scene without steps of its solution; they can be taken once.
  py::list takeStages() {
    py::list list;
    for (Fields& stage : stages_)
      list.append(dictOf(stage));
    stages_.clear();
    return list;
  }

  py::dict history() const {
    py::dict dict;
    const auto column = [&]<class T>(const char* name, T qp::StepRecord::*member) {
      std::vector<T> values;
      for (const qp::StepRecord& record : history_)
        values.push_back(record.*member);
      dict[name] = arrayOf(std::move(values));
    };
    column("iteration", &qp::StepRecord::iteration);
    column("outer", &qp::StepRecord::outer);
    column("projected_gradient", &qp::StepRecord::projectedGradient);
    column("objective", &qp::StepRecord::objective);
    column("active_bounds", &qp::StepRecord::activeBounds);
    column("hessian_multiplications", &qp::StepRecord::hessianMultiplications);
    return dict;
  }

  /// Collective.
  std::filesystem::path write(const std::filesystem::path& directory, const std::string& name) const {
    const py::gil_scoped_release noLock;
    output::FileSet files(comm_, false);
    const auto fields = output::writeFields(directory, name, run_.solved(), run_.evaluation, history_, files);
    output::writeHistory(history_, directory / "history.csv", files);
    output::writeReport(simulation::reportOf(run_.result), directory / "report.xml", files);
    files.publish();
    return fields.hdf5;
  }

private:
  py::dict dictOf(Fields& stage) {
    py::dict bodies, contacts, ties, dict;
    for (int b = 0; b < std::ssize(stage.bodies); ++b)
      bodies[py::str(run_.decomposition->bodies[b].name)] =
          bodyOf(stage.bodies[b], run_.scene.bodies[b], stage, b);
    for (std::size_t c = 0; c < stage.contacts.size(); ++c)
      contacts[py::str(run_.decomposition->contacts[c].name)] = contactOf(stage.contacts[c]);
    for (std::size_t t = 0; t < stage.ties.size(); ++t)
      ties[py::str(run_.decomposition->ties[t].name)] =
          py::dict(py::arg("points") = arrayOf(std::move(stage.ties[t].points), 3),
                   py::arg("traction") = arrayOf(std::move(stage.ties[t].traction), 3));
    dict["name"] = stage.result.steps.empty() ? "" : stage.result.steps.back().name;
    dict["bodies"] = bodies;
    dict["contacts"] = contacts;
    dict["ties"] = ties;
    dict["report"] = python::dictOf(simulation::reportOf(stage.result));
    return dict;
  }

  simulation::SceneRun run_;
  std::vector<Fields> stages_;
  RCP<const Comm> comm_;
  qp::History history_;
};

/// \param text     of a scene as XML; empty: it is in the file
/// \param file     its name, for messages, too
/// \param progress as Watch has it
/// Collective.
std::unique_ptr<Run> solveScene(const std::string& text, const std::string& file,
                                const std::vector<std::string>& overrides, std::uintptr_t address,
                                const py::object& progress) {
  const RCP<const Comm> comm = communicator(address);
  Watch watch(comm, progress);
  std::vector<Fields> stages;
  std::unique_ptr<Run> solved;
  try {
    const py::gil_scoped_release noLock;
    const double began = Teuchos::Time::wallTime();
    Teuchos::ParameterList given =
        text.empty() ? scene::readParameterFile(file, *comm) : scene::parseParameters(text, file);
    for (const std::string& assignment : overrides)
      scene::applyOverride(given, assembly::withAutomatic(simulation::driverSchema()), assignment);
    drivers::takeFoundPairs(given, file, *comm);
    const auto keep = [&](const simulation::SceneRun& stage) { stages.push_back(fieldsOf(stage)); };
    simulation::SceneRun run =
        drivers::solveTask(drivers::readTask(given, file), comm, &watch, {.mesh = {}, .step = keep});
    run.result.times.total = maxOverRanks(*comm, Teuchos::Time::wallTime() - began);
    if (run.result.status != simulation::RunStatus::interrupted) {
      keep(run);
      solved = std::make_unique<Run>(std::move(run), std::move(stages), comm);
    }
  } catch (const simulation::Interrupted&) { // on all ranks
    solved.reset();
  }
  if (!solved)
    watch.raise();
  return solved;
}

} // namespace

void defineScenes(py::module_& module) {
  py::class_<Run>(module, "Run")
      .def_property_readonly(
          "converged", [](const Run& run) { return run.result().status == simulation::RunStatus::converged; })
      .def_property_readonly("status", [](const Run& run) { return statusOf(run.result()); })
      .def_property_readonly("reason", [](const Run& run) { return run.result().reason; })
      .def_property_readonly("summary", [](const Run& run) { return drivers::summary(run.result()); })
      .def_property_readonly("report",
                             [](const Run& run) { return dictOf(simulation::reportOf(run.result())); })
      .def("take_stages", &Run::takeStages)
      .def("history", &Run::history)
      .def("write", &Run::write);
  module.def("solve_scene", &solveScene);
}

} // namespace epafi::python
