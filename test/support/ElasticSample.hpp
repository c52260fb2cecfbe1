#pragma once

#include "GmshBox.hpp"
#include "TemporaryDirectory.hpp"

#include "epafi/fetidp/solve/ContactSolution.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/Scene.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <fstream>
#include <functional>

namespace epafi::test {

/// A kind of elastic body.
struct Kind {
  fem::Physics physics = fem::Physics::planeStrain;
  mesh::CellType cell = mesh::CellType::quadrilateral;
};

inline const std::vector<Kind>& kinds() {
  using fem::Physics;
  using mesh::CellType;
  static const std::vector<Kind> all{{Physics::planeStrain, CellType::triangle},
                                     {Physics::planeStress, CellType::quadrilateral},
                                     {Physics::elasticity3d, CellType::tetrahedron},
                                     {Physics::elasticity3d, CellType::hexahedron}};
  return all;
}

inline std::vector<double> evenLines(double from, double to, int cells) {
  std::vector<double> lines;
  for (int i = 0; i <= cells; ++i)
    lines.push_back(from + (to - from) * i / cells);
  return lines;
}

/// Writes a mesh file on rank 0; every rank may read it afterwards. Collective.
inline std::string writeMesh(const TemporaryDirectory& directory, const Comm& comm, const std::string& name,
                             mesh::CellType type, const GridLines& lines) {
  const std::filesystem::path file = directory.path() / name;
  comm.barrier(); // other ranks may still read an older file of the name
  if (comm.getRank() == 0)
    std::ofstream(file) << GmshBox(type, lines).text();
  comm.barrier();
  return file.string();
}

/// The unit square or cube, its last coordinate from `bottom` to bottom + 1, of 4 cells a side, in METIS'
/// parts (or one); from a file where a structured mesh has no such cells. Collective.
inline scene::Body elasticBlock(const Kind& kind, const std::string& name, double bottom, int parts,
                                const TemporaryDirectory& directory, const Comm& comm) {
  constexpr int cells = 4;
  const bool isPlane = mesh::dimensionOf(kind.cell) == 2;
  scene::Body body;
  body.name = name;
  body.decomposition.method = scene::Decomposition::Method::metis;
  body.decomposition.parts = parts;
  body.physics = kind.physics;
  body.material = {1.0, 200.0, 0.3, 0.5};
  if (kind.cell == mesh::CellType::triangle || kind.cell == mesh::CellType::tetrahedron) {
    const std::vector<double> across = evenLines(0, 1, cells), up = evenLines(bottom, bottom + 1, cells);
    body.mesh.file = writeMesh(directory, comm, name + ".msh", kind.cell,
                               isPlane ? GridLines{across, up, {}} : GridLines{across, across, up});
  } else {
    body.mesh.box = isPlane ? mesh::Box{{0, bottom, 0}, {1, bottom + 1, 0}}
                            : mesh::Box{{0, 0, bottom}, {1, 1, bottom + 1}};
    body.mesh.elements = {cells, cells, isPlane ? 0 : cells};
  }
  body.supports.push_back({"symmetry in x", "left", {0.0, std::nullopt, std::nullopt}});
  if (!isPlane)
    body.supports.push_back({"symmetry in y", "front", {std::nullopt, 0.0, std::nullopt}});
  return body;
}

/// Two blocks, the lower one on a sliding floor, the upper one, which floats, pressed down on it. Collective.
inline scene::Scene stackedBlocks(const Kind& kind, int parts, double pressure,
                                  const TemporaryDirectory& directory, const Comm& comm) {
  scene::Scene scene;
  scene.bodies = {elasticBlock(kind, "lower", 0, parts, directory, comm),
                  elasticBlock(kind, "upper", 1, parts, directory, comm)};
  fem::SolidSupport floor{"floor", "bottom", {}};
  floor.value[static_cast<std::size_t>(mesh::dimensionOf(kind.cell)) - 1] = 0.0;
  scene.bodies[0].supports.push_back(floor);
  scene.bodies[1].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {pressure, 0, 0}}};
  scene.contacts = {{"joint", 0, "top", 1, "bottom"}};
  return scene;
}

using Field = std::function<std::array<double, 3>(const Point&)>;

/// A solution with the displacement `field` and no contact force.
inline fetidp::ContactSolution solutionWith(const model::Decomposition& decomposition, const Field& field) {
  const auto& problem = decomposition.problem;
  fetidp::ContactSolution solution;
  for (const auto& subdomain : problem.subdomains) {
    const auto& mesh = *decomposition.bodies[subdomain.body].mesh;
    Eigen::VectorXd u(static_cast<Eigen::Index>(subdomain.nodes.size()) * problem.components);
    for (std::size_t k = 0; k < subdomain.nodes.size(); ++k)
      for (int c = 0; c < problem.components; ++c)
        u[static_cast<Eigen::Index>(k) * problem.components + c] = field(mesh.point(subdomain.nodes[k]))[c];
    solution.displacement.push_back(u);
  }
  solution.multiplier = rcp(new Vector(problem.multiplierMap));
  solution.slack = rcp(new Vector(problem.multiplierMap));
  solution.active = rcp(new Vector(problem.multiplierMap));
  return solution;
}

} // namespace epafi::test
