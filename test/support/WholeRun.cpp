#include "WholeRun.hpp"

#include "epafi/base/Collective.hpp"

#include <Tpetra_Core.hpp>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace epafi::test {
namespace {

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');)
    result.push_back(field);
  return result;
}

} // namespace

std::vector<Row> referenceRows(const std::string& name) {
  std::ifstream file(EPAFI_SOURCE_DIR "/test/reference/" + name);
  std::string line;
  if (!std::getline(file, line))
    throw std::runtime_error("cannot read test/reference/" + name);
  const std::vector<std::string> names = fields(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = fields(line);
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i)
      row[names[i]] = values.at(i);
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const std::string& column) {
  return std::stod(row.at(column));
}

scene::Scene cutInGrid(scene::Scene scene, int counts) {
  for (auto& body : scene.bodies)
    body.decomposition = {scene::Decomposition::Method::grid, {counts, counts}, 1};
  return scene;
}

scene::Scene cutByMetis(scene::Scene scene, int parts) {
  for (auto& body : scene.bodies)
    body.decomposition = {scene::Decomposition::Method::metis, {1, 1}, parts};
  return scene;
}

simulation::SceneRun solve(const scene::Scene& scene, double tolerance, const RCP<const Comm>& comm,
                           Teuchos::ParameterList solver) {
  solver.set("Tolerance", tolerance).set("Equilibrium Tolerance", tolerance);
  return simulation::solveScene(scene, solver, comm);
}

simulation::SceneRun solve(const scene::Scene& scene, double tolerance) {
  return solve(scene, tolerance, Tpetra::getDefaultComm());
}

Eigen::VectorXd deflection(const simulation::SceneRun& run, int body) {
  const auto& problem = run.decomposition->problem;
  const auto& mesh = *run.decomposition->bodies[body].mesh;
  const Eigen::Index n = problem.components;
  const Eigen::Index numNodes = mesh.numNodes();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(n * numNodes), copies = Eigen::VectorXd::Zero(n * numNodes);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    if (problem.subdomains[s].body == body)
      for (std::size_t i = 0; i < problem.subdomains[s].nodes.size(); ++i) {
        const Eigen::Index node = problem.subdomains[s].nodes[i];
        sum.segment(n * node, n) += run.solution.displacement[s].segment(n * static_cast<Eigen::Index>(i), n);
        copies.segment(n * node, n).array() += 1;
      }
  sumOverRanks(*problem.comm, {sum.data(), static_cast<std::size_t>(sum.size())});
  sumOverRanks(*problem.comm, {copies.data(), static_cast<std::size_t>(copies.size())});
  return sum.cwiseQuotient(copies);
}

} // namespace epafi::test
