#include "Preconditioned.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

RCP<const Comm> thisRankOnly() {
  const RCP<const Comm> all = world();
  return all->split(all->getRank(), 0);
}

Preconditioned::Preconditioned(const scene::Scene& scene, const PreconditionerParameters& parameters,
                               const RCP<const Comm>& comm)
    : decomposition(decompose(scene, comm)), problem(decomposition.problem),
      inverse(std::make_shared<GeneralizedInverse>(problem, DirectSolvers())), f(inverse),
      m(problem, inverse, parameters) {}

Eigen::MatrixXd kernelRows(const DecomposedProblem& problem) {
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(problem.dualDimension()), problem.kernelDimension);
  for (const KernelEntry& entry : kernelConstraint(problem))
    rows(static_cast<Eigen::Index>(problem.multiplierMap->getGlobalElement(entry.row)), entry.mode) +=
        entry.value;
  sumOverRanks(*problem.comm, {rows.data(), static_cast<std::size_t>(rows.size())});
  return rows;
}

Eigen::MatrixXd kernelOf(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0)
    return Eigen::MatrixXd::Identity(columns.rows(), columns.rows());
  return direct::orthogonalComplement(columns);
}

Eigen::VectorXd spectrum(const Preconditioned& preconditioned) {
  const Eigen::MatrixXd f = matrixOf(preconditioned.f), m = matrixOf(preconditioned.m);
  std::vector<Eigen::Index> touched;
  for (Eigen::Index i = 0; i < f.rows(); ++i)
    if (f(i, i) != 0)
      touched.push_back(i);
  const Eigen::MatrixXd rows = kernelRows(preconditioned.problem);
  const Eigen::MatrixXd z = kernelOf(rows(touched, allOf));
  const Eigen::MatrixXd fz = z.transpose() * f(touched, touched) * z,
                        mz = z.transpose() * m(touched, touched) * z;
  const Eigen::MatrixXd lower = direct::choleskyFactor(0.5 * (mz + mz.transpose())).value();
  const Eigen::MatrixXd product = lower.transpose() * fz * lower; // similar to MF
  return direct::eigenOf(0.5 * (product + product.transpose())).values;
}

double conditionNumber(const Preconditioned& preconditioned) {
  const Eigen::VectorXd eigenvalues = spectrum(preconditioned);
  return eigenvalues.maxCoeff() / eigenvalues.minCoeff();
}

Eigen::VectorXd scaledSpectrum(const Eigen::MatrixXd& symmetric) {
  const Eigen::VectorXd scale = symmetric.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * (0.5 * (symmetric + symmetric.transpose())) * scale.asDiagonal();
  return direct::eigenOf(scaled).values;
}

double scaledAsymmetry(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (matrix - matrix.transpose()) * scale.asDiagonal()).cwiseAbs().maxCoeff();
}

namespace {

std::string kindOf(bool coercive) {
  return coercive ? "coercive, " : "semicoercive, ";
}

/// The two membranes and a third one on top of the left one: its corner is in two contacts.
scene::Scene contactsThatMeet(bool coercive) {
  scene::Scene scene = twoMembranes(coercive, 4, grid(2, 2));
  scene::Body top = scene.bodies.front();
  top.name = "top";
  top.mesh.box = mesh::rectangle(0, 1, 1, 2);
  top.supports = {{"ceiling", "top", {0.0}}};
  scene.bodies.push_back(top);
  scene.contacts.push_back({"seam", 0, "top", 2, "bottom", {}, 0.0});
  return scene;
}

} // namespace

std::vector<ContactCase> hardCases() {
  std::vector<ContactCase> cases;
  for (const bool coercive : {true, false}) {
    for (const double jump : {1e-6, 1e6}) {
      const std::string what = kindOf(coercive) + (jump < 1 ? "jumps of 1e-6 " : "jumps of 1e6 ");
      scene::Scene bodies = twoMembranes(coercive, 4, grid(2, 2)), regions = bodies;
      bodies.bodies[1].material.conductivity = jump;
      cases.push_back({what + "between bodies", bodies, coercive});
      for (scene::Body& body : bodies.bodies)
        body.decomposition = metis(3);
      cases.push_back({what + "between bodies, METIS", bodies, coercive});
      // Where a body floats P mixes all rows of contact, so that a soft part of the other one must not be
      // among them.
      const mesh::Box corner = mesh::rectangle(coercive ? 0.5 : 0.0, coercive ? 1.0 : 0.5, 0, 0.5);
      regions.bodies[0].regions = {{"corner", corner, "", {jump}}};
      regions.bodies[1].regions = {{"lower right", mesh::rectangle(1.5, 2, 0, 0.5), "", {jump}}};
      cases.push_back({what + "between regions", regions, coercive});
    }
    scene::Scene heldEnd = twoMembranes(coercive, 4, grid(2, 2));
    heldEnd.bodies[0].supports.push_back({"foot", "bottom", {0.0}});
    cases.push_back({kindOf(coercive) + "contact that ends at one body's support", heldEnd, coercive});
    cases.push_back({kindOf(coercive) + "contacts that meet", contactsThatMeet(coercive), coercive});
    cases.push_back({kindOf(coercive) + "three bodies", threeMembranes(!coercive, 4, grid(2, 2)), false});
  }
  scene::Scene heldEnds = twoMembranes(true, 4, grid(2, 2));
  for (scene::Body& body : heldEnds.bodies)
    body.supports.push_back({"foot", "bottom", {0.0}});
  cases.push_back({"contact that ends at both bodies' supports", heldEnds, true});
  return cases;
}

std::vector<ContactCase> jumpsInside() {
  std::vector<ContactCase> cases;
  for (const bool coercive : {true, false})
    for (const double jump : {1e-6, 1e6})
      for (const auto& cut : {grid(2, 2), metis(3)}) {
        scene::Scene scene = twoMembranes(coercive, 4, cut);
        scene.bodies[0].regions = {{"corner", mesh::rectangle(0.5, 1, 0, 0.5), "", {jump}}};
        scene.bodies[1].regions = {{"strip", mesh::rectangle(1, 1.75, 0, 0.25), "", {jump}}};
        cases.push_back({kindOf(coercive) + (jump < 1 ? "1e-6 inside" : "1e6 inside"), scene, coercive});
      }
  return cases;
}

std::vector<PreconditionerParameters> allPreconditioners(bool isSingle) {
  std::vector<PreconditionerParameters> all;
  for (const Type type : {Type::lumped, Type::dirichlet})
    for (const Scaling scaling : {Scaling::multiplicity, Scaling::stiffness})
      all.push_back({type, scaling, isSingle});
  return all;
}

} // namespace epafi::fetidp
