#include "DenseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <random>

namespace epafi::fetidp {
namespace {

using decomposition::mergedColumns;
using decomposition::mergedSize;

/// Number of copies of each merged unknown. Collective.
Eigen::VectorXd countCopies(const DecomposedProblem& problem) {
  Eigen::VectorXd copies = Eigen::VectorXd::Zero(mergedSize(problem));
  for (const auto& columns : mergedColumns(problem))
    for (const Eigen::Index column : columns)
      copies[column] += 1;
  decomposition::sumEntries(*problem.comm, copies);
  return copies;
}

} // namespace

scene::Scene threeMembranes(bool lastFloats, int elements, const scene::Decomposition& cut) {
  scene::Scene scene = twoMembranes(false, elements, cut);
  scene::Body last = scene.bodies.back();
  scene.bodies.back().name = "middle";
  last.mesh.box = mesh::rectangle(2, 3, 0, 1);
  if (!lastFloats)
    last.supports = {{"wall", "right", {0.0}}};
  scene.bodies.push_back(last);
  scene.contacts.push_back({"second interface", 1, "right", 2, "left", {}, 0.0});
  for (scene::Body& body : scene.bodies)
    setLoad(body, -1.0);
  return scene;
}

void setLoad(scene::Body& body, double value) {
  body.loads = {fem::loadInside("all over", body.mesh.box, value)};
}

void setHalves(scene::Body& body, double lower, double upper) {
  mesh::Box low = body.mesh.box, high = low;
  low.upper[1] = high.lower[1] = 0.5 * (body.mesh.box.lower[1] + body.mesh.box.upper[1]);
  body.loads = {fem::loadInside("lower half", low, lower), fem::loadInside("upper half", high, upper)};
}

std::vector<ContactCase> clusteredCases() {
  std::vector<ContactCase> cases;
  for (const bool coercive : {true, false})
    cases.push_back({std::string(coercive ? "coercive" : "semicoercive") + ", four subdomains a cluster",
                     twoMembranes(coercive, 12, clustered(grid(2, 4), 4)), coercive});
  return cases;
}

std::vector<ContactCase> contactCases() {
  std::vector<ContactCase> cases;
  for (const bool coercive : {true, false}) {
    const std::string kind = coercive ? "coercive, " : "semicoercive, ";
    cases.push_back({kind + "2x2 elements a subdomain", twoMembranes(coercive, 4, grid(2, 2)), coercive});
    cases.push_back({kind + "one subdomain a body", twoMembranes(coercive, 4, grid(1, 1)), coercive});
    cases.push_back({kind + "uneven grid", twoMembranes(coercive, 5, grid(3, 1)), coercive});
    cases.push_back({kind + "one element a subdomain", twoMembranes(coercive, 3, grid(3, 3)), coercive});
    cases.push_back({kind + "METIS", twoMembranes(coercive, 6, metis(3)), coercive});
    cases.push_back(
        {kind + "a subdomain a cluster", twoMembranes(coercive, 6, clustered(grid(2, 2), 1)), coercive});
    scene::Scene withBystander = twoMembranes(coercive, 4, grid(2, 1));
    withBystander.bodies.push_back(
        decomposition::oneBody(2, 2, grid(1, 1), {{"foot", "bottom", {0.0}}}).bodies.front());
    cases.push_back({kind + "a subdomain without multipliers", withBystander, coercive});
  }
  cases.push_back({"two of three float", threeMembranes(true, 4, grid(2, 1)), false});
  cases.push_back({"the middle one floats", threeMembranes(false, 4, metis(2)), false});
  for (ContactCase& c : cases) {
    setHalves(c.scene.bodies[0], 4.0, -5.0);
    setHalves(c.scene.bodies[1], -3.0, 2.0);
    if (c.scene.bodies.size() > 2)
      setHalves(c.scene.bodies[2], 0.5, -1.0);
  }
  return cases;
}

std::vector<ContactCase> floatingCases() {
  std::vector<ContactCase> cases;
  for (const ContactCase& c : contactCases())
    if (!c.coercive)
      cases.push_back(c);
  return cases;
}

DenseProblem densify(const DecomposedProblem& problem) {
  DenseProblem dense;
  dense.stiffness = decomposition::mergedStiffness(problem);
  dense.constraint = decomposition::mergedConstraint(problem);
  dense.kernel = Eigen::MatrixXd::Zero(mergedSize(problem), problem.kernelDimension);
  const auto columns = mergedColumns(problem);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const auto& subdomain = problem.subdomains[s];
    const int offset = problem.kernelOffsetOf(subdomain);
    for (std::size_t i = 0; i < columns[s].size(); ++i) {
      const Eigen::Index unknown = i;
      dense.kernel.row(columns[s][i]).segment(offset, subdomain.kernel.cols()) +=
          subdomain.kernel.row(unknown);
    }
  }
  decomposition::sumEntries(*problem.comm, dense.kernel);
  dense.kernel.array().colwise() /= countCopies(problem).array(); // the mean of copies that agree
  return dense;
}

DenseProblem densify(const DecomposedProblem& problem, const decomposition::ProblemData& data) {
  DenseProblem dense = densify(problem);
  dense.load = Eigen::VectorXd::Zero(mergedSize(problem));
  const auto columns = mergedColumns(problem);
  for (std::size_t s = 0; s < columns.size(); ++s)
    dense.load(columns[s]) += data.subdomains()[s].rightHandSide();
  decomposition::sumEntries(*problem.comm, dense.load);
  dense.gap = gathered(data.gap());
  return dense;
}

SubdomainVectors valuesOf(const DecomposedProblem& problem, const Eigen::VectorXd& merged) {
  SubdomainVectors values;
  for (const auto& columns : mergedColumns(problem))
    values.emplace_back(merged(columns));
  return values;
}

SubdomainVectors forcesOf(const DecomposedProblem& problem, const Eigen::VectorXd& merged) {
  SubdomainVectors forces = valuesOf(problem, merged);
  // The copy in the lowest subdomain takes a crosspoint's force.
  Eigen::VectorXd lowest = Eigen::VectorXd::Constant(mergedSize(problem), problem.numSubdomains);
  const auto columns = mergedColumns(problem);
  for (std::size_t s = 0; s < columns.size(); ++s)
    for (const Eigen::Index column : columns[s])
      lowest[column] = std::min(lowest[column], static_cast<double>(problem.subdomains[s].number));
  for (double& number : lowest)
    number = minOverRanks(*problem.comm, number);
  for (std::size_t s = 0; s < columns.size(); ++s)
    for (std::size_t i = 0; i < columns[s].size(); ++i)
      if (lowest[columns[s][i]] != problem.subdomains[s].number)
        forces[s](static_cast<Eigen::Index>(i)) = 0;
  return forces;
}

Eigen::VectorXd mergeValues(const DecomposedProblem& problem, const SubdomainVectors& u) {
  Eigen::VectorXd merged = Eigen::VectorXd::Zero(mergedSize(problem));
  const auto columns = mergedColumns(problem);
  for (std::size_t s = 0; s < columns.size(); ++s)
    for (std::size_t i = 0; i < columns[s].size(); ++i)
      merged[columns[s][i]] += u[s](static_cast<Eigen::Index>(i));
  decomposition::sumEntries(*problem.comm, merged);
  return merged.cwiseQuotient(countCopies(problem));
}

Eigen::MatrixXd matrixOf(const Operator& a) {
  const Eigen::Index n = a.getDomainMap()->getGlobalNumElements();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  if (n == 0)
    return matrix;
  MultiVector unit(a.getDomainMap(), static_cast<std::size_t>(n)),
      image(a.getRangeMap(), unit.getNumVectors());
  const auto indices = localIndices(*a.getDomainMap());
  for (const GlobalOrdinal index : indices)
    unit.replaceGlobalValue(index, static_cast<std::size_t>(index), 1.0);
  a.apply(unit, image);
  for (Eigen::Index column = 0; column < n; ++column) {
    const auto values = image.getData(static_cast<std::size_t>(column));
    for (Teuchos_Ordinal row = 0; row < values.size(); ++row)
      matrix(static_cast<Eigen::Index>(indices[static_cast<decltype(indices.size())>(row)]), column) =
          values[row];
  }
  decomposition::sumEntries(*a.getDomainMap()->getComm(), matrix);
  return matrix;
}

Eigen::VectorXd gathered(const Vector& x) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(x.getGlobalLength()));
  const auto indices = localIndices(*x.getMap());
  const auto values = x.getData();
  for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
    all[indices[static_cast<decltype(indices.size())>(i)]] = values[i];
  decomposition::sumEntries(*x.getMap()->getComm(), all);
  return all;
}

RCP<Vector> spread(const RCP<const Map>& map, const Eigen::VectorXd& values) {
  const RCP<Vector> x = rcp(new Vector(map));
  for (const GlobalOrdinal index : localIndices(*map))
    x->replaceGlobalValue(index, values[index]);
  return x;
}

Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& symmetric) {
  if (symmetric.rows() == 0)
    return symmetric;
  const direct::SymmetricEigen eigen = direct::eigenOf(symmetric);
  const double threshold = 1e-10 * eigen.values.cwiseAbs().maxCoeff();
  const Eigen::VectorXd inverse =
      eigen.values.unaryExpr([threshold](double value) { return value > threshold ? 1.0 / value : 0.0; });
  return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
}

double relativeError(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / std::max(b.norm(), 1e-300);
}

Eigen::VectorXd randomVector(Eigen::Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd x(n);
  for (double& value : x)
    value = normal(random);
  return x;
}

} // namespace epafi::fetidp
