#include "Reference.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/EigenCompatibility.hpp"

#include <Eigen/QR>
#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>

namespace epafi::fetidp {
namespace {

/// The problem over all nodes of all bodies, supported ones too (one unknown a node).
struct PrimalProblem {
  Eigen::MatrixXd stiffness, constraint; ///< K; B_I
  Eigen::VectorXd load, gap, prescribed; ///< f; c; values of supported nodes, 0 elsewhere
  Eigen::VectorXd copies;                ///< of each node in the subdomains
  std::vector<Eigen::Index> firstNode;   ///< of each body; one more at the end
  std::vector<Eigen::Index> unknowns;    ///< nodes that are free
  double energyOffset = 0;
};

/// Where a subdomain's unknown lies among all nodes.
Eigen::Index nodeOf(const PrimalProblem& primal, const decomposition::Subdomain& subdomain, int position) {
  return primal.firstNode[subdomain.body] + static_cast<Eigen::Index>(subdomain.nodes[position]);
}

std::vector<Eigen::Index> firstColumns(const model::Decomposition& decomposition) {
  std::vector<Eigen::Index> first{0};
  for (const auto& body : decomposition.bodies)
    first.push_back(first.back() + static_cast<Eigen::Index>(body.mesh->numNodes()));
  return first;
}

void addSubdomain(const DecomposedProblem& problem, const decomposition::Subdomain& subdomain,
                  const decomposition::SubdomainData& data, PrimalProblem& primal, Eigen::VectorXd& isFree) {
  std::vector<Eigen::Index> node;
  for (const int position : subdomain.unknownPosition)
    node.push_back(nodeOf(primal, subdomain, position));
  for (int j = 0; j < subdomain.stiffness->outerSize(); ++j)
    for (decomposition::SparseMatrix::InnerIterator entry(*subdomain.stiffness, j); entry; ++entry)
      primal.stiffness(node[entry.row()], node[j]) += entry.value();
  const Eigen::VectorXd load = data.rightHandSide();
  for (std::size_t i = 0; i < node.size(); ++i) {
    primal.load[node[i]] += load[i];
    isFree[node[i]] += 1;
  }
  for (Eigen::Index i = 0; i < data.prescribed.size(); ++i) {
    const Eigen::Index at = nodeOf(primal, subdomain, static_cast<int>(i));
    primal.prescribed[at] += data.prescribed[i];
    primal.copies[at] += 1;
  }
  for (const auto& entry : subdomain.constraint) {
    const GlobalOrdinal row = problem.numberOf(entry.multiplier);
    if (row < problem.numInequalities)
      primal.constraint(static_cast<Eigen::Index>(row), node[entry.unknown]) += entry.coefficient;
  }
  primal.energyOffset += data.energyOffset();
}

PrimalProblem assemble(const model::Decomposition& decomposition) {
  const DecomposedProblem& problem = decomposition.problem;
  PrimalProblem primal;
  primal.firstNode = firstColumns(decomposition);
  const Eigen::Index n = primal.firstNode.back();
  primal.stiffness = Eigen::MatrixXd::Zero(n, n);
  primal.constraint = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(problem.numInequalities), n);
  primal.load = primal.prescribed = primal.copies = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd isFree = Eigen::VectorXd::Zero(n);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    addSubdomain(problem, problem.subdomains[s], decomposition.data.subdomains()[s], primal, isFree);
  decomposition::sumEntries(*problem.comm, primal.stiffness);
  decomposition::sumEntries(*problem.comm, primal.constraint);
  for (Eigen::VectorXd* vector : {&primal.load, &primal.prescribed, &primal.copies, &isFree})
    decomposition::sumEntries(*problem.comm, *vector);
  primal.energyOffset = sumOverRanks(*problem.comm, primal.energyOffset);
  primal.prescribed.array() /= primal.copies.array();
  primal.gap = gathered(decomposition.data.gap()).head(primal.constraint.rows());
  for (Eigen::Index node = 0; node < n; ++node)
    if (isFree[node] > 0)
      primal.unknowns.push_back(node);
  return primal;
}

Field split(const PrimalProblem& primal, const Eigen::VectorXd& values) {
  Field field;
  for (std::size_t b = 0; b + 1 < primal.firstNode.size(); ++b)
    field.emplace_back(values.segment(primal.firstNode[b], primal.firstNode[b + 1] - primal.firstNode[b]));
  return field;
}

} // namespace

Teuchos::ParameterList toleranceOf(double tolerance) {
  Teuchos::ParameterList list = ContactSolver::validParameters();
  list.set("Tolerance", tolerance);
  list.set("Equilibrium Tolerance", tolerance);
  return list;
}

Solved::Solved(const scene::Scene& scene, double tolerance)
    : decomposition(decompose(scene, world())), solver(toleranceOf(tolerance)) {
  solver.setup(decomposition.problem, decomposition.data);
  solution = solver.solve(decomposition.data);
}

Field fieldOf(const model::Decomposition& decomposition, const ContactSolution& solution) {
  PrimalProblem primal;
  primal.firstNode = firstColumns(decomposition);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(primal.firstNode.back()), copies = values;
  for (std::size_t s = 0; s < solution.displacement.size(); ++s)
    for (Eigen::Index i = 0; i < solution.displacement[s].size(); ++i) {
      const Eigen::Index node = nodeOf(primal, decomposition.problem.subdomains[s], static_cast<int>(i));
      values[node] += solution.displacement[s][i];
      copies[node] += 1;
    }
  decomposition::sumEntries(*decomposition.problem.comm, values);
  decomposition::sumEntries(*decomposition.problem.comm, copies);
  return split(primal, values.cwiseQuotient(copies));
}

double largestJump(const model::Decomposition& decomposition, const ContactSolution& solution) {
  const Field mean = fieldOf(decomposition, solution);
  double jump = 0;
  for (std::size_t s = 0; s < solution.displacement.size(); ++s) {
    const auto& subdomain = decomposition.problem.subdomains[s];
    for (std::size_t i = 0; i < subdomain.nodes.size(); ++i)
      jump = std::max(jump, std::abs(solution.displacement[s][i] - mean[subdomain.body][subdomain.nodes[i]]));
  }
  return maxOverRanks(*decomposition.problem.comm, jump);
}

double fieldError(const Field& a, const Field& b) {
  double difference = 0, size = 0;
  for (std::size_t body = 0; body < b.size(); ++body) {
    difference = std::max(difference, (a[body] - b[body]).lpNorm<Eigen::Infinity>());
    size = std::max(size, b[body].lpNorm<Eigen::Infinity>());
  }
  return size > 0 ? difference / size : difference;
}

PrimalSolution solveUndecomposed(const model::Decomposition& decomposition) {
  const PrimalProblem primal = assemble(decomposition);
  const Eigen::MatrixXd k = primal.stiffness(primal.unknowns, primal.unknowns),
                        b = primal.constraint(allOf, primal.unknowns);
  const Eigen::VectorXd f = primal.load(primal.unknowns);
  const Eigen::Index n = k.rows(), m = b.rows();
  const double unit = k.diagonal().mean(); // forces and gaps compared

  Eigen::VectorXd u = Eigen::VectorXd::Zero(n), force = Eigen::VectorXd::Zero(m);
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < m; ++i)
    active.push_back(i);
  for (int step = 0; step < 100; ++step) { // [K Bᵀ; B 0] on the active rows, then the rows that want to be
    const Eigen::Index a = active.size();
    Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(n + a, n + a);
    Eigen::VectorXd right(n + a);
    saddle.topLeftCorner(n, n) = k / unit;
    saddle.bottomLeftCorner(a, n) = b(active, allOf);
    saddle.topRightCorner(n, a) = b(active, allOf).transpose();
    right << f / unit, primal.gap(active);
    const Eigen::VectorXd solution = saddle.completeOrthogonalDecomposition().solve(right);
    u = solution.head(n);
    force.setZero();
    force(active) = unit * solution.tail(a);
    std::vector<Eigen::Index> next;
    for (Eigen::Index i = 0; i < m; ++i)
      if (force[i] + unit * (b.row(i).dot(u) - primal.gap[i]) > 0)
        next.push_back(i);
    if (next == active)
      break;
    active = next;
  }

  PrimalSolution result;
  result.force = force;
  const Eigen::VectorXd slack = primal.gap - b * u;
  result.energy = 0.5 * u.dot(k * u) - f.dot(u) + primal.energyOffset;
  const double length =
      std::max({u.lpNorm<Eigen::Infinity>(), primal.gap.size() > 0 ? primal.gap.norm() : 0.0, 1e-300});
  result.violation = (k * u - f + b.transpose() * force).norm() / (unit * length);
  for (Eigen::Index i = 0; i < m; ++i)
    result.violation = std::max({result.violation, -force[i] / (unit * length), -slack[i] / length,
                                 std::min(force[i] / unit, slack[i]) / length});
  Eigen::VectorXd values = primal.prescribed;
  values(primal.unknowns) = u;
  result.field = split(primal, values);
  return result;
}

} // namespace epafi::fetidp
