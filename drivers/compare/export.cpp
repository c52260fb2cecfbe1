/// `epafi-export SCENE.xml FILE`: the scene's contact problem as one system, for `compare/peers` and whoever
/// wants to solve it otherwise. What stands in FILE, and in what order: `usage`, UndecomposedSystem.hpp; how:
/// PetscFile.hpp.

#include "CommandLine.hpp"
#include "JointEnd.hpp"
#include "PetscFile.hpp"
#include "UndecomposedSystem.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/ParameterOverride.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>

#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace epafi;
using namespace epafi::drivers;

constexpr const char* usage =
    "Usage: epafi-export SCENE.xml FILE [--set \"List/Sub list/Parameter=value\"]...\n"
    "Writes min 1/2 u'Ku - f'u, Bu <= c of a scene of elastic bodies, undecomposed, in PETSc's binary "
    "format:\n"
    "  matrix K, vector f, matrix B, vector c, vector e, indices body, indices node, vector x, vector d\n"
    "e (length 1) is the energy of prescribed displacements alone. Unknown i is the displacement of node "
    "node[i]\n"
    "of body body[i] (both from 0), which lies at x[3i..3i+2], along d[3i..3i+2]. On one rank.\n"
    "Exit codes: 0 written, 1 not written, 2 wrong input, 3 the scene contradicts itself.\n";

struct Request {
  std::string scene, file;
  std::vector<std::string> overrides;
  bool help = false;
};

Request parse(int argc, const char* const* argv) {
  Request request;
  CommandLine line("epafi-export");
  line.value("--set", [&](const std::string& text) { request.overrides.push_back(text); })
      .words([&](const std::string& word) {
        if (!request.file.empty())
          throw InputError("'" + word + "' is not understood; see epafi-export --help");
        (request.scene.empty() ? request.scene : request.file) = word;
      });
  request.help = line.parse(argc, argv);
  if (!request.help && request.file.empty())
    throw InputError("a scene and a file to write are needed; see epafi-export --help");
  return request;
}

scene::Scene read(const Request& request) {
  Teuchos::ParameterList list = scene::readParameterFile(request.scene, *Tpetra::getDefaultComm());
  const Teuchos::ParameterList schema = simulation::driverSchema();
  for (const std::string& text : request.overrides)
    scene::applyOverride(list, schema, text);
  scene::Scene scene = scene::readScene(list, request.scene);
  for (const scene::Body& body : scene.bodies) // x and d of FILE mean nothing to them
    if (body.physics == fem::Physics::membrane)
      throw InputError("body '" + body.name + "' is a membrane; only elastic bodies can be exported");
  for (const scene::SurfaceContact& contact : scene.contacts) // the programs that read FILE know bounds alone
    if (contact.kind == scene::SurfaceContact::Kind::tied)
      throw InputError("contact '" + contact.name + "' is a tied joint; only contacts can be exported");
    else if (contact.hasFriction())
      throw InputError("contact '" + contact.name + "' has friction; only contacts without can be exported");
  return scene;
}

void write(const UndecomposedSystem& system, const std::string& name) {
  const auto values = [](const auto& array) {
    return std::span<const double>(array.data(), static_cast<std::size_t>(array.size()));
  };
  PetscFile file(name);
  file.write(system.stiffness);
  file.write(values(system.load));
  file.write(system.constraint);
  file.write(values(system.gap));
  file.write(std::span(&system.energyOffset, 1));
  file.write(system.body);
  file.write(system.node);
  file.write(values(system.place));
  file.write(values(system.direction));
  file.close();
}

} // namespace

int main(int argc, char** argv) {
  return runMain(argc, argv, "epafi-export", [&](const RCP<const Comm>& comm) {
    const Request request = parse(argc, argv);
    if (comm->getSize() > 1)
      throw InputError("epafi-export runs on one rank; start it without mpirun");
    if (request.help)
      std::cout << usage;
    else
      write(undecomposedSystem(read(request)), request.file);
    return 0;
  });
}
