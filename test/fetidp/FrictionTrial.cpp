#include "FrictionTrial.hpp"

#include "support/DenseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::test {

using namespace decomposition;

namespace {

/// What a node takes of an integral over the bottom of the upper block or, in a stack, the lower one's.
double shareOf(const VectorXd& place, int n, int order) {
  double area = 1;
  for (Index axis = 0; axis + 1 < place.size(); ++axis) {
    const int last = order * n, i = static_cast<int>(std::lround(last * place[axis]));
    const double weight = i == 0 || i == last ? 1 : 2;
    area *= order == 1 ? weight / (2 * n) : (i % 2 == 1 ? 4.0 : weight) / (6 * n);
  }
  return area;
}

/// Entries of this rank's rows. Added over all ranks they are the matrix.
MatrixXd denseRows(const CrsMatrix& rows) {
  MatrixXd dense = MatrixXd::Zero(static_cast<Index>(rows.getGlobalNumRows()),
                                  static_cast<Index>(rows.getDomainMap()->getGlobalNumElements()));
  CrsMatrix::local_inds_host_view_type columns;
  CrsMatrix::values_host_view_type values;
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(localIndices(*rows.getRowMap()).size()); ++row) {
    rows.getLocalRowView(row, columns, values);
    for (std::size_t k = 0; k < columns.extent(0); ++k)
      dense(rows.getRowMap()->getGlobalElement(row), rows.getColMap()->getGlobalElement(columns(k))) +=
          values(k);
  }
  sumEntries(*world(), dense);
  return dense;
}

VectorXd denseValues(const Vector& vector, Index size) {
  VectorXd dense = VectorXd::Zero(size);
  const auto values = vector.getData();
  for (LocalOrdinal i = 0; i < values.size(); ++i)
    if (const auto place = static_cast<Index>(vector.getMap()->getGlobalElement(i)); place < size)
      dense[place] = values[i];
  sumEntries(*world(), dense);
  return dense;
}

} // namespace

Trial::Trial(const Draw& drawn, const scene::Decomposition& cut) : draw(drawn) {
  scene::Scene scene = draw.scene;
  for (scene::Body& body : scene.bodies)
    body.decomposition = cut;
  std::vector<SubdomainMatrix> matrices = matricesOf(scene, Supports::prescribed);
  const model::Decomposition direct = model::decompose(scene, world());
  const ConstraintMatrix contact = contactOf(scene, direct, Supports::prescribed);
  FrictionRows friction = frictionAlong(contact, draw.dimension);
  assemble(matrices, contact, friction);
  problem = handOver(scene, std::move(matrices));
  problem->setContact(contact);
  problem->setFriction(friction);
  problem->complete();
  std::vector<double> bounds, coefficients;
  for (const FrictionNode& node : problem->problem().frictionNodes) {
    const NodeLaw& law = whole.laws[static_cast<std::size_t>(problem->problem().numberOf(node.contact))];
    bounds.push_back(law.bound);
    coefficients.push_back(law.coefficient);
  }
  data = problem->data();
  data.setFrictionBounds(problem->problem(), bounds);
  data.setFrictionCoefficients(problem->problem(), coefficients);
}

void Trial::assemble(const std::vector<SubdomainMatrix>& matrices, const ConstraintMatrix& contact,
                     FrictionRows& friction) {
  const Index n = draw.dimension, t = n - 1;
  const MatrixXd normals = denseRows(*contact.rows), tangents = denseRows(*friction.tangents.rows);
  const Index numUnknowns = normals.cols(), numNodes = normals.rows();
  whole.components = n;
  whole.stiffness = MatrixXd::Zero(numUnknowns, numUnknowns);
  whole.load = VectorXd::Zero(numUnknowns);
  MatrixXd marks = MatrixXd::Zero(numUnknowns, 4 + n); // copies, held, prescribed, body, place
  for (const SubdomainMatrix& matrix : matrices) {
    for (Index j = 0; j < matrix.stiffness.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(matrix.stiffness, static_cast<int>(j)); entry; ++entry)
        whole.stiffness(matrix.unknowns[static_cast<std::size_t>(entry.row())],
                        matrix.unknowns[static_cast<std::size_t>(entry.col())]) += entry.value();
    for (std::size_t i = 0; i < matrix.unknowns.size(); ++i) {
      const auto place = static_cast<Index>(matrix.unknowns[i]);
      whole.load[place] += matrix.load[static_cast<Index>(i)];
      marks(place, 0) += 1;
      marks(place, 3) += matrix.body;
      marks.row(place).tail(n) += matrix.coordinates.row(static_cast<Index>(i));
    }
    for (const auto& [unknown, value] : matrix.prescribed) {
      marks(static_cast<Index>(unknown), 1) += 1;
      marks(static_cast<Index>(unknown), 2) += value;
    }
  }
  sumEntries(*world(), whole.stiffness);
  sumEntries(*world(), whole.load);
  sumEntries(*world(), marks);
  whole.prescribed = marks.col(2).cwiseQuotient(marks.col(0));
  whole.places = marks.rightCols(n).array().colwise() / marks.col(0).array();
  for (Index i = 0; i < numUnknowns; ++i) {
    whole.isHeld.push_back(marks(i, 1) > 0);
    whole.body.push_back(static_cast<int>(std::lround(marks(i, 3) / marks(i, 0))));
  }
  whole.rows.resize(n * numNodes, numUnknowns);
  for (Index node = 0; node < numNodes; ++node) {
    whole.rows.row(n * node) = normals.row(node);
    whole.rows.middleRows(n * node + 1, t) = tangents.middleRows(t * node, t);
    Index touched = 0;
    normals.row(node).cwiseAbs().maxCoeff(&touched);
    const double area = shareOf(whole.places.row(touched), draw.elements, draw.order);
    whole.laws.push_back({draw.traction * area, draw.coefficient});
  }
  drawJumps(contact, friction);
}

void Trial::drawJumps(const ConstraintMatrix& contact, FrictionRows& friction) {
  const Index n = draw.dimension, t = n - 1, numNodes = whole.rows.rows() / n;
  const VectorXd gaps = denseValues(*contact.gap, numNodes);
  whole.gap = VectorXd::Zero(whole.rows.rows());
  Dice dice(draw.seed + 1000000);
  VectorXd jumps = VectorXd::Zero(t * numNodes);
  for (Index node = 0; node < numNodes; ++node) {
    whole.gap[n * node] = gaps[node];
    for (Index k = 0; k < t; ++k) {
      const double jump = draw.jump * dice.between(-1, 1);
      double moves = 0;
      for (Index i = 0; i < whole.rows.cols(); ++i)
        moves += whole.isHeld[static_cast<std::size_t>(i)] ? 0 : std::abs(whole.rows(n * node + 1 + k, i));
      if (moves > 0)
        jumps[t * node + k] = whole.gap[n * node + 1 + k] = jump;
      else
        jumps[t * node + k] = whole.gap[n * node + 1 + k] =
            whole.rows.row(n * node + 1 + k).dot(whole.prescribed);
    }
  }
  const RCP<Vector> shared = rcp(new Vector(friction.tangents.gap->getMap()));
  for (const GlobalOrdinal row : localIndices(*shared->getMap()))
    shared->replaceGlobalValue(row, jumps[static_cast<Index>(row)]);
  friction.tangents.gap = shared;
}

void Trial::solve() {
  solver = std::make_unique<ContactSolver>(
      Teuchos::ParameterList().set("Tolerance", 5e-11).set("Equilibrium Tolerance", 5e-11));
  try {
    solver->setup(problem->problem(), data);
    solution = solver->solve(data);
  } catch (const SolvabilityError& error) {
    refusal = error.what();
    return;
  }
  const Index numUnknowns = whole.stiffness.rows(), n = draw.dimension;
  u = denseValues(*problem->unknowns(solution.displacement), numUnknowns);
  force = VectorXd::Zero(whole.rows.rows());
  const auto values = solution.multiplier->getData(), active = solution.active->getData();
  VectorXd states = VectorXd::Zero(whole.rows.rows() / n);
  for (const FrictionNode& node : problem->problem().frictionNodes) {
    const auto number = static_cast<Index>(problem->problem().numberOf(node.contact));
    force[n * number] = values[node.contact];
    for (int k = 0; k < n - 1; ++k)
      force[n * number + 1 + k] = values[node.firstTangent + k];
    states[number] = active[node.contact] + 2 * active[node.firstTangent];
  }
  sumEntries(*world(), force);
  sumEntries(*world(), states);
  state = states;
}

bool Trial::fellBack() const {
  const qp::SolveReport& report = solver->report();
  return std::count_if(report.history.begin(), report.history.end(),
                       [](const qp::StepRecord& step) { return step.kind == qp::StepKind::start; }) > 1;
}

} // namespace epafi::test
