#include "Gathered.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Eigen/SparseCholesky>
#include <Tpetra_Core.hpp>

#include <limits>

namespace epafi::decomposition {

std::vector<std::vector<Eigen::Index>> mergedColumns(const DecomposedProblem& problem) {
  const Eigen::Index numRemainders = problem.remainderMap->getGlobalNumElements();
  Eigen::Index next = problem.remainderMap->getMinGlobalIndex();
  std::vector<std::vector<Eigen::Index>> columns;
  for (const Subdomain& s : problem.subdomains) {
    std::vector<Eigen::Index> column(s.unknownPosition.size(), -1);
    for (const int unknown : s.remainderUnknowns)
      column[unknown] = next++;
    for (std::size_t k = 0; k < s.crosspointUnknowns.size(); ++k)
      column[s.crosspointUnknowns[k]] = numRemainders + static_cast<Eigen::Index>(s.crosspointIndices[k]);
    columns.push_back(column);
  }
  return columns;
}

Eigen::Index mergedSize(const DecomposedProblem& problem) {
  return static_cast<Eigen::Index>(problem.remainderMap->getGlobalNumElements() +
                                   problem.crosspointMap->getGlobalNumElements());
}

RCP<const Comm> world() {
  return Tpetra::getDefaultComm();
}

scene::Decomposition grid(int nx, int ny) {
  return {scene::Decomposition::Method::grid, {nx, ny}, 1};
}

scene::Decomposition metis(int parts) {
  return {scene::Decomposition::Method::metis, {1, 1}, parts};
}

scene::Scene oneBody(int n, int m, const scene::Decomposition& cut,
                     const std::vector<fem::SolidSupport>& supports) {
  scene::Body body;
  body.name = "plate";
  body.mesh.box = mesh::rectangle(0, 1, 0, 1);
  body.mesh.elements = {n, m, 0};
  body.supports = supports;
  body.decomposition = cut;
  body.loads = {fem::loadInside("all", mesh::rectangle(0, 1, 0, 1), -1.0)};
  return {"one body", {body}, {}, {}};
}

scene::Scene twoMembranes(bool coercive, int elements, const scene::Decomposition& cut) {
  scene::Scene scene = oneBody(elements, elements, cut, {{"wall", "left", {0.0}}});
  scene.bodies.push_back(scene.bodies.front());
  scene.bodies.front().name = "left";
  scene.bodies.back().name = "right";
  scene.bodies.back().mesh.box = mesh::rectangle(1, 2, 0, 1);
  scene.bodies.back().supports.clear();
  if (coercive)
    scene.bodies.back().supports = {{"wall", "right", {0.0}}};
  scene.contacts = {{"interface", 0, "right", 1, "left", {}, 0.0}};
  return scene;
}

double nodeKey(const Subdomain& subdomain, int unknown, int components) {
  const int position = subdomain.unknownPosition[unknown];
  return 1e6 * (subdomain.body + 1) + static_cast<double>(subdomain.nodes[position / components]);
}

Eigen::MatrixXd mergedStiffness(const DecomposedProblem& problem) {
  const Eigen::Index n = mergedSize(problem);
  Eigen::MatrixXd merged = Eigen::MatrixXd::Zero(n, n);
  const auto columns = mergedColumns(problem);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const SparseMatrix& k = *problem.subdomains[s].stiffness;
    for (int j = 0; j < k.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(k, j); entry; ++entry)
        merged(columns[s][entry.row()], columns[s][j]) += entry.value();
  }
  sumEntries(*problem.comm, merged);
  return merged;
}

Eigen::MatrixXd mergedConstraint(const DecomposedProblem& problem) {
  Eigen::MatrixXd merged =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(problem.dualDimension()), mergedSize(problem));
  const auto columns = mergedColumns(problem);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (const ConstraintEntry& entry : problem.subdomains[s].constraint)
      merged(static_cast<Eigen::Index>(problem.numberOf(entry.multiplier)), columns[s][entry.unknown]) +=
          entry.coefficient;
  sumEntries(*problem.comm, merged);
  return merged;
}

double smallestPivot(const DecomposedProblem& problem) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Subdomain& s : problem.subdomains) {
    const Eigen::Index n = s.remainderUnknowns.size();
    if (n == 0)
      continue;
    std::vector<Eigen::Triplet<double>> pick;
    for (Eigen::Index k = 0; k < n; ++k)
      pick.emplace_back(s.remainderUnknowns[k], k, 1.0);
    SparseMatrix select(s.stiffness->rows(), n);
    select.setFromTriplets(pick.begin(), pick.end());
    const SparseMatrix krr = select.transpose() * *s.stiffness * select;
    const Eigen::SimplicialLDLT<SparseMatrix> factor(krr);
    if (factor.info() != Eigen::Success)
      return -1;
    const double largest = Eigen::VectorXd(krr.diagonal()).maxCoeff();
    smallest = std::min(smallest, factor.vectorD().minCoeff() / largest);
  }
  return smallest;
}

int kernelDimension(const Eigen::MatrixXd& symmetric) {
  if (symmetric.rows() == 0)
    return 0;
  const direct::SymmetricEigen eigen = direct::eigenOf(symmetric);
  return static_cast<int>(eigen.numUpTo(1e-10 * eigen.values.maxCoeff()));
}

scene::Decomposition clustered(scene::Decomposition cut, int size) {
  cut.cluster = size;
  return cut;
}

std::vector<Case> smallCases() {
  const fem::SolidSupport left{"left", "left", {0.0}}, right{"right", "right", {0.0}},
      top{"top", "top", {0.0}}, bottom{"bottom", "bottom", {0.0}};
  std::vector<Case> cases;
  for (const bool coercive : {true, false}) {
    const std::string kind = coercive ? "coercive " : "semicoercive ";
    cases.push_back({kind + "2x2", twoMembranes(coercive, 8, grid(2, 2))});
    cases.push_back({kind + "1x1", twoMembranes(coercive, 4, grid(1, 1))});
    cases.push_back({kind + "3x1", twoMembranes(coercive, 7, grid(3, 1))});
    for (const int parts : {1, 3, 7, 16})
      cases.push_back({kind + "metis " + std::to_string(parts), twoMembranes(coercive, 9, metis(parts))});
  }
  cases.push_back({"strip of single elements", oneBody(7, 1, grid(7, 1), {})});
  cases.push_back({"strip held at its foot", oneBody(1, 5, grid(1, 5), {bottom})});
  cases.push_back({"strip held along both sides", oneBody(6, 1, grid(6, 1), {bottom, top})});
  cases.push_back({"interface with supported ends", oneBody(6, 4, grid(2, 1), {bottom, top})});
  cases.push_back({"rows with supported ends", oneBody(4, 6, grid(1, 3), {left, right})});
  cases.push_back({"one element a subdomain", oneBody(4, 4, grid(4, 4), {left})});
  cases.push_back({"one element a part", oneBody(3, 3, metis(9), {})});
  cases.push_back({"held all around", oneBody(6, 6, metis(5), {left, right, top, bottom})});
  return cases;
}

} // namespace epafi::decomposition
