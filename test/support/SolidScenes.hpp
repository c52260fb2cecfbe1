#pragma once

/// Scenes of blocks for tests, built without files, and their solutions.

#include "epafi/ContactSolver.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/model/Decompose.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace epafi::test {

using fem::Physics;

inline scene::Decomposition cutByMetis(int parts) {
  scene::Decomposition cut;
  cut.method = scene::Decomposition::Method::metis;
  cut.parts = parts;
  return cut;
}

inline scene::Decomposition cutInGrid(std::array<int, 3> counts) {
  scene::Decomposition cut;
  cut.counts = counts;
  return cut;
}

inline fem::SolidSupport slide(const std::string& surface, double normal = 0) {
  return {"slide on " + surface, surface, {}, normal};
}

/// A block in the plane (z: 0) or in space.
inline scene::Body block(const std::string& name, const mesh::Box& box, std::array<int, 3> elements,
                         const scene::Decomposition& cut) {
  scene::Body body;
  body.name = name;
  body.physics = elements[2] > 0 ? Physics::elasticity3d : Physics::planeStrain;
  body.material.youngsModulus = 200;
  body.mesh.box = box;
  body.mesh.elements = elements;
  body.decomposition = cut;
  return body;
}

inline fem::SolidLoad weight(const Vector3& force) {
  return {"weight", fem::SolidLoad::Kind::body, {}, "", {0, 0, 0}, force};
}

/// On a surface, by which the load is called.
inline fem::SolidLoad loadOn(const std::string& surface, const Vector3& value,
                             fem::SolidLoad::Kind kind = fem::SolidLoad::Kind::traction) {
  return {surface, kind, {}, surface, {0, 0, 0}, value};
}

inline fem::SolidLoad pointForce(const Vector3& point, const Vector3& force) {
  return {"force", fem::SolidLoad::Kind::point, {}, "", point, force};
}

inline scene::SurfaceContact onPlane(const std::string& name, int body, const std::string& surface,
                                     const Vector3& point, const Vector3& normal) {
  scene::SurfaceContact contact;
  contact.name = name;
  contact.first = body;
  contact.firstSurface = surface;
  contact.obstacle.point = point;
  contact.obstacle.normal = normal;
  return contact;
}

inline scene::SurfaceContact between(const std::string& name, int first, const std::string& firstSurface,
                                     int second, const std::string& secondSurface) {
  return {name, first, firstSurface, second, secondSurface};
}

/// A solved scene.
struct SolidRun {
  model::Decomposition decomposition;
  ContactSolver solver;
  fetidp::ContactSolution solution;

  explicit SolidRun(const scene::Scene& scene, double tolerance = 1e-10,
                    const RCP<const Comm>& comm = Tpetra::getDefaultComm())
      : decomposition(model::decompose(scene, comm)),
        solver(Teuchos::ParameterList().set("Tolerance", tolerance).set("Equilibrium Tolerance", tolerance)) {
    solver.setup(decomposition.problem, decomposition.data);
    solution = solver.solve(decomposition.data);
  }

  /// u of a body at its nodes, on every rank.
  [[nodiscard]] Eigen::VectorXd displacement(int body) const {
    const decomposition::DecomposedProblem& problem = decomposition.problem;
    const int n = problem.components;
    const std::size_t numNodes = decomposition.bodies[body].mesh->numNodes();
    std::vector<double> sums(numNodes * static_cast<std::size_t>(n), 0.0), copies(numNodes, 0.0);
    for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
      const auto& subdomain = problem.subdomains[s];
      for (std::size_t k = 0; subdomain.body == body && k < subdomain.nodes.size(); ++k) {
        const std::size_t node = subdomain.nodes[k];
        copies[node] += 1;
        for (int c = 0; c < n; ++c)
          sums[node * static_cast<std::size_t>(n) + static_cast<std::size_t>(c)] +=
              solution.displacement[s][static_cast<Eigen::Index>(k) * n + c];
      }
    }
    sumOverRanks(*problem.comm, sums);
    sumOverRanks(*problem.comm, copies);
    Eigen::VectorXd u(static_cast<Eigen::Index>(sums.size()));
    for (std::size_t i = 0; i < sums.size(); ++i)
      u[i] = sums[i] / copies[i / static_cast<std::size_t>(n)];
    return u;
  }

  /// λ of the contact rows, on every rank.
  [[nodiscard]] std::vector<double> forces() const { return onContactRows(*solution.multiplier); }
  /// 1 where contact is closed, 0 elsewhere, on every rank.
  [[nodiscard]] std::vector<double> active() const { return onContactRows(*solution.active); }

private:
  [[nodiscard]] std::vector<double> onContactRows(const Vector& vector) const {
    const decomposition::DecomposedProblem& problem = decomposition.problem;
    std::vector<double> rows(problem.numInequalities, 0.0);
    const auto values = vector.getData();
    for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
      if (const auto row = problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i));
          row < problem.numInequalities)
        rows[row] = values[i];
    sumOverRanks(*problem.comm, rows);
    return rows;
  }
};

/// What became of a scene: nothing if it was solved.
struct Refusal {
  std::optional<SolvabilityError::Kind> kind;
  std::string text;

  [[nodiscard]] bool says(const std::string& words) const { return text.find(words) != std::string::npos; }
};

inline Refusal refusalOf(const scene::Scene& scene) {
  try {
    const SolidRun run(scene);
    EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
  } catch (const SolvabilityError& error) {
    return {error.kind(), error.what()};
  }
  return {};
}

inline void expectNotUnique(const scene::Scene& scene, const std::vector<std::string>& words) {
  const Refusal refusal = refusalOf(scene);
  EXPECT_EQ(refusal.kind, SolvabilityError::Kind::notUnique) << refusal.text;
  for (const std::string& word : words)
    EXPECT_TRUE(refusal.says(word)) << word << " is not in: " << refusal.text;
}

inline void expectNoSolution(const scene::Scene& scene, const std::vector<std::string>& words) {
  const Refusal refusal = refusalOf(scene);
  EXPECT_EQ(refusal.kind, SolvabilityError::Kind::noSolution) << refusal.text;
  for (const std::string& word : words)
    EXPECT_TRUE(refusal.says(word)) << word << " is not in: " << refusal.text;
}

} // namespace epafi::test
