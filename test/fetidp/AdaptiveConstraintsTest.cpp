#include "support/Preconditioned.hpp"
#include "support/Reference.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"
#include "epafi/fetidp/precondition/CorrectedPreconditioner.hpp"
#include "epafi/fetidp/precondition/Joints.hpp"
#include "epafi/fetidp/precondition/OverratedColumns.hpp"
#include "epafi/qp/operators/DeflatedOperator.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace epafi::fetidp {
namespace {

using Use = AdaptiveConstraintParameters::Use;

/// Two membranes with channels of conductivity `jump` across the cut, closed in a part of the contact.
scene::Scene channels(bool coercive, double jump, const scene::Decomposition& cut, int elements = 12) {
  scene::Scene scene = twoMembranes(coercive, elements, cut);
  setHalves(scene.bodies[0], 4.0, -5.0);
  setHalves(scene.bodies[1], -3.0, 2.0);
  const double h = 1.0 / elements;
  for (scene::Body& body : scene.bodies)
    for (const int row : {1, elements / 3, elements / 2 + 1, elements - 2}) {
      const double x = body.mesh.box.lower[0];
      body.regions.push_back({"along", mesh::rectangle(x, x + 1, row * h, (row + 1) * h), "", {jump}});
      body.regions.push_back({"upwards", mesh::rectangle(x + row * h, x + (row + 1) * h, 0, 1), "", {jump}});
    }
  return scene;
}

/// One membrane without contact, likewise.
scene::Scene oneBodyWithChannels(double jump, const scene::Decomposition& cut) {
  scene::Scene scene = channels(true, jump, cut);
  scene.bodies.resize(1);
  scene.contacts.clear();
  return scene;
}

/// Without the channels upwards, with which those along make one stiff grid of each subdomain.
scene::Scene withoutUpwards(scene::Scene scene) {
  for (scene::Body& body : scene.bodies)
    std::erase_if(body.regions, [](const auto& region) { return region.name == "upwards"; });
  return scene;
}

/// As planned with these parameters.
OverratedColumns overrated(const Preconditioned& p, RowKind kind,
                           const AdaptiveConstraintParameters& parameters) {
  const Plan chosen = plan(factsOf(p.problem), {{.adaptiveConstraints = parameters}});
  return findOverratedColumns(p.problem, *p.inverse, kind,
                              kind == RowKind::gluing ? chosen.gluing : chosen.contact, Scaling::stiffness);
}

/// F, M and what deflation makes of F.
struct Deflated : Preconditioned {
  Deflated(const scene::Scene& scene, const AdaptiveConstraintParameters& parameters,
           const RCP<const Comm>& comm = world())
      : Preconditioned(scene, {}, comm), constraints(overrated(*this, RowKind::gluing, parameters)),
        operatorF(rcp(new DualOperator(inverse))),
        deflated(operatorF, spaceOf(constraints, *inverse->multiplierPlan(), *operatorF)) {}

  /// U, n_λ × n_U, on every rank. Collective.
  [[nodiscard]] Eigen::MatrixXd columns() const {
    Eigen::MatrixXd u =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(problem.dualDimension()), constraints.number);
    for (const OverratedColumns::Entry& entry : constraints.entries)
      u(static_cast<Eigen::Index>(problem.multiplierGhostMap->getGlobalElement(entry.row)), entry.column) =
          entry.value;
    sumOverRanks(*problem.comm, {u.data(), static_cast<std::size_t>(u.size())});
    return u;
  }

  OverratedColumns constraints;
  RCP<const DualOperator> operatorF;
  qp::DeflatedOperator deflated;
};

/// Eigenvalues of M F_U on Ker G but for the zeros that U makes, ascending. Collective.
Eigen::VectorXd spectrum(const Deflated& d, const Operator& preconditioner) {
  const Eigen::MatrixXd z = kernelOf(kernelRows(d.problem));
  const Eigen::MatrixXd m = z.transpose() * matrixOf(preconditioner) * z,
                        f = z.transpose() * matrixOf(d.deflated) * z;
  const Eigen::MatrixXd lower = direct::choleskyFactor(0.5 * (m + m.transpose())).value();
  const Eigen::MatrixXd product = lower.transpose() * (0.5 * (f + f.transpose())) * lower;
  const Eigen::VectorXd all = direct::eigenOf(product).values;
  EXPECT_LE(all.head(d.constraints.number).lpNorm<Eigen::Infinity>(), 1e-7);
  return all.tail(all.size() - d.constraints.number);
}

/// Most joints of a subdomain, N. Collective.
int mostJoints(const Deflated& d) {
  std::map<int, int> numOf;
  int most = 0;
  for (const Joint& joint : jointsOf(d.problem, *d.inverse->multiplierPlan(), RowKind::gluing))
    for (const int number : joint.subdomains)
      most = std::max(most, ++numOf[number]);
  return static_cast<int>(maxOverRanks(*d.problem.comm, most));
}

TEST(AdaptiveConstraintsTest, FUIsFWithoutWhatUStandsFor) {
  for (const bool coercive : {true, false}) {
    const Deflated d(channels(coercive, 1e3, grid(2, 2)), {Use::yes, 3});
    const Eigen::MatrixXd f = matrixOf(d.f), u = d.columns(), fu = f * u;
    ASSERT_GT(d.constraints.number, 3);
    const Eigen::MatrixXd expected = f - fu * direct::solvedSymmetric(u.transpose() * fu, fu.transpose());
    EXPECT_LE((matrixOf(d.deflated) - expected).norm(), 1e-9 * f.norm());
    EXPECT_LE((matrixOf(d.deflated) * u).norm(), 1e-9 * fu.norm());
    EXPECT_LE(scaledAsymmetry(matrixOf(d.deflated)), 1e-9);
  }
}

TEST(AdaptiveConstraintsTest, UTouchesNeitherContactNorEquilibrium) {
  for (const auto& cut :
       {grid(2, 2), clustered(grid(4, 1), 1), clustered(grid(4, 2), 2), clustered(metis(6), 2)}) {
    SCOPED_TRACE(testing::Message() << cut.counts[0] << ' ' << cut.counts[1] << ' ' << cut.cluster);
    const scene::Scene all = channels(false, 1e3, cut);
    const Deflated d(cut.cluster > 0 ? withoutUpwards(all) : all, {Use::yes, 3});
    const Eigen::MatrixXd u = d.columns();
    ASSERT_GT(u.cols(), 0);
    EXPECT_EQ(u.topRows(static_cast<Eigen::Index>(d.problem.numInequalities)).norm(), 0);
    EXPECT_LE((kernelRows(d.problem).transpose() * u).norm(), 1e-12 * u.norm());
  }
}

/// Joints of several clusters are looked at like others, but for the motions of these, which G takes care of.
TEST(AdaptiveConstraintsTest, ChannelsThroughClustersCostNothing) {
  for (const auto& cut : {clustered(grid(3, 1), 1), clustered(grid(4, 2), 1)}) {
    SCOPED_TRACE(testing::Message() << cut.counts[0] << ' ' << cut.counts[1]);
    const auto largest = [&](double jump, double threshold) {
      const Deflated d(withoutUpwards(oneBodyWithChannels(jump, cut)), {Use::yes, threshold}, thisRankOnly());
      return spectrum(d, d.m).maxCoeff();
    };
    EXPECT_LE(largest(1e6, 6), 2 * largest(1, 6));
    EXPECT_GE(largest(1e6, 1e12), 1e3);
  }
}

TEST(AdaptiveConstraintsTest, TheSpectrumOfGluingIsBoundedByTheThreshold) {
  for (const auto& cut : {grid(3, 3), metis(6)})
    for (const double jump : {1.0, 1e-4, 1e6})
      for (const double threshold : {2.0, 6.0, 30.0}) {
        SCOPED_TRACE(testing::Message() << cut.parts << ' ' << jump << ' ' << threshold);
        const Deflated d(oneBodyWithChannels(jump, cut), {Use::yes, threshold}, thisRankOnly());
        const Eigen::VectorXd eigenvalues = spectrum(d, d.m);
        EXPECT_GE(eigenvalues.minCoeff(), 1 - 1e-6);
        EXPECT_LE(eigenvalues.maxCoeff(), mostJoints(d) * mostJoints(d) * threshold);
      }
}

TEST(AdaptiveConstraintsTest, WithoutThemTheSpectrumGrowsWithTheJump) {
  for (const auto& cut : {grid(3, 3), metis(6)}) {
    const double without = conditionNumber(Preconditioned(oneBodyWithChannels(1e6, cut), {}, thisRankOnly()));
    const Deflated with(oneBodyWithChannels(1e6, cut), {}, thisRankOnly());
    EXPECT_GE(without, 1e4);
    EXPECT_LE(spectrum(with, with.m).maxCoeff(), 30);
  }
}

TEST(AdaptiveConstraintsTest, AHigherThresholdAsksForFewer) {
  std::vector<int> numbers;
  for (const double threshold : {1.5, 3.0, 10.0, 1e3, 1e9}) {
    const Deflated d(channels(true, 1e6, grid(3, 3)), {Use::yes, threshold});
    numbers.push_back(d.constraints.number);
  }
  EXPECT_TRUE(std::is_sorted(numbers.rbegin(), numbers.rend()));
  EXPECT_GT(numbers.front(), numbers[2]);
  EXPECT_GT(numbers[2], 0);
  EXPECT_EQ(numbers.back(), 0);
}

TEST(AdaptiveConstraintsTest, TheWorstJumpsComeFirst) {
  const scene::Scene scene = channels(true, 1e6, grid(3, 3));
  const Deflated all(scene, {Use::yes, 10});
  const Deflated few(scene, {Use::yes, 10, 100, 5});
  ASSERT_GT(all.constraints.number, 5);
  EXPECT_EQ(few.constraints.number, 5);
  EXPECT_EQ(few.constraints.largestRatio, all.constraints.largestRatio);
}

TEST(AdaptiveConstraintsTest, AutoLooksAlongJumpsOnly) {
  const Deflated uniform(channels(true, 1, grid(3, 3)), {});
  EXPECT_EQ(uniform.constraints.numJoints, 0);
  scene::Scene scene = channels(true, 1, grid(3, 3));
  scene.bodies[0].regions = {
      {"channel", mesh::rectangle(0, 1, 1.0 / 12, 2.0 / 12), "", {1e6}}}; // crosses two edges
  EXPECT_EQ(Deflated(scene, {}).constraints.numJoints, 2);
  EXPECT_EQ(Deflated(scene, {Use::yes}).constraints.numJoints, 24);
}

TEST(AdaptiveConstraintsTest, TheyAreTheSameOnAnyNumberOfRanks) {
  for (const auto& cut : {grid(3, 3), metis(5)}) {
    const scene::Scene scene = channels(false, 1e4, cut);
    const Deflated here(scene, {}, thisRankOnly()), shared(scene, {});
    ASSERT_GT(here.constraints.number, 0);
    ASSERT_EQ(shared.constraints.number, here.constraints.number);
    EXPECT_EQ(shared.constraints.largestRatio, here.constraints.largestRatio);
    const Eigen::MatrixXd u = here.columns() - shared.columns();
    EXPECT_LE(u.norm(), 1e-13 * here.columns().norm());
    EXPECT_LE(relativeError(matrixOf(shared.deflated), matrixOf(here.deflated)), 1e-13);
  }
}

/// The preconditioner with its correction for contact, and F_U.
struct Corrected : Deflated {
  Corrected(const scene::Scene& scene, const AdaptiveConstraintParameters& parameters,
            const RCP<const Comm>& comm = world())
      : Deflated(scene, parameters, comm), jumps(overrated(*this, RowKind::contact, parameters)),
        constrained(rcp(new DualPreconditioner(problem, inverse, {}, Teuchos::rcpFromRef(deflated)))),
        corrected(constrained, spaceOf(jumps, *inverse->multiplierPlan(), deflated, constrained.get())) {}

  OverratedColumns jumps;
  RCP<const DualPreconditioner> constrained; ///< M, with crosspoints that keep the constraints
  CorrectedPreconditioner corrected;
};

TEST(AdaptiveConstraintsTest, TheCorrectedPreconditionerIsItsFormula) {
  for (const bool coercive : {true, false}) {
    const Corrected c(channels(coercive, 1e4, grid(2, 2)), {Use::yes, 5});
    ASSERT_GT(c.jumps.number, 0);
    Eigen::MatrixXd v =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(c.problem.dualDimension()), c.jumps.number);
    for (const OverratedColumns::Entry& entry : c.jumps.entries)
      v(static_cast<Eigen::Index>(c.problem.multiplierGhostMap->getGlobalElement(entry.row)), entry.column) =
          entry.value;
    sumOverRanks(*c.problem.comm, {v.data(), static_cast<std::size_t>(v.size())});
    EXPECT_EQ(v.bottomRows(static_cast<Eigen::Index>(c.problem.numEqualities)).norm(), 0); // contact alone
    const Eigen::MatrixXd h = matrixOf(c.deflated), m = matrixOf(*c.constrained),
                          corrected = matrixOf(c.corrected);
    v = (m * v).eval();
    const Eigen::MatrixXd inverse = direct::inverseOfSpd(v.transpose() * h * v);
    const Eigen::MatrixXd p =
        Eigen::MatrixXd::Identity(h.rows(), h.cols()) - v * inverse * (h * v).transpose();
    const Eigen::MatrixXd expected = p * m * p.transpose() + v * inverse * v.transpose();
    EXPECT_LE(relativeError(corrected, expected), 1e-8);
    EXPECT_LE(scaledAsymmetry(corrected), 1e-8);
    EXPECT_GT(scaledSpectrum(corrected).minCoeff(), 0);
    EXPECT_LE(relativeError(corrected * h * v, v), 1e-6); // M_V H = 1 on V
  }
}

TEST(AdaptiveConstraintsTest, WithTheCorrectionContactForgetsTheJumpToo) {
  for (const auto& cut : {grid(3, 3), metis(6)}) {
    SCOPED_TRACE(cut.parts);
    scene::Scene scene = channels(false, 1e6, cut);
    for (scene::Body& body : scene.bodies)
      std::erase_if(body.regions, [](const fem::SolidRegion& region) { return region.name == "upwards"; });
    const Corrected c(scene, {}, thisRankOnly());
    const Eigen::VectorXd deflated = spectrum(c, *c.constrained), corrected = spectrum(c, c.corrected);
    EXPECT_GE(deflated.maxCoeff(), 1e3); // channels end at the contact
    EXPECT_LE(corrected.maxCoeff(), 100);
    EXPECT_GE(corrected.minCoeff(), 1 - 1e-5);
  }
}

Teuchos::ParameterList parameters(const std::string& use, double threshold = 1.5) {
  Teuchos::ParameterList list = toleranceOf(1e-11);
  list.sublist("Adaptive Constraints").set("Use", use).set("Threshold", threshold);
  return list;
}

struct Solution {
  Solution(const scene::Scene& scene, const Teuchos::ParameterList& list)
      : decomposition(decompose(scene, world())), solver(list) {
    solver.setup(decomposition.problem, decomposition.data);
    solution = solver.solve(decomposition.data);
  }
  [[nodiscard]] Field field() const { return fieldOf(decomposition, solution); }

  model::Decomposition decomposition;
  ContactSolver solver;
  ContactSolution solution;
};

TEST(AdaptiveConstraintsTest, TheyChangeNoSolution) {
  std::vector<ContactCase> cases = contactCases();
  for (const bool coercive : {true, false})
    for (const auto& cut : {grid(3, 3), metis(5)})
      cases.push_back({"channels", channels(coercive, 1e3, cut), coercive});
  cases.push_back({"no contact", oneBodyWithChannels(1e3, grid(3, 3)), true});
  int numUsed = 0;
  for (const ContactCase& c : cases) {
    SCOPED_TRACE(c.name);
    const Solution without(c.scene, parameters("no")), with(c.scene, parameters("yes"));
    EXPECT_EQ(with.solver.report().status, qp::Status::converged);
    EXPECT_LE(fieldError(with.field(), without.field()), 1e-9);
    EXPECT_NEAR(with.solution.energy, without.solution.energy, 1e-9 * std::abs(without.solution.energy));
    const Eigen::VectorXd force = gathered(*with.solution.multiplier),
                          expected = gathered(*without.solution.multiplier);
    EXPECT_LE(relativeError(force, expected), 1e-7);
    numUsed += with.solver.dualProblem().deflatedOperator().is_null() ? 0 : 1;
  }
  EXPECT_GE(numUsed, 12);
}

TEST(AdaptiveConstraintsTest, TheyServeOtherLoadsAndWarmStarts) {
  for (const bool coercive : {true, false}) {
    const scene::Scene scene = channels(coercive, 1e5, grid(3, 3));
    Solution solution(scene, parameters("auto", 10));
    const int cold = solution.solver.report().counts.hessianMultiplications;
    const ContactSolution again =
        solution.solver.solve(solution.decomposition.data, &*solution.solution.multiplier);
    EXPECT_LE(solution.solver.report().counts.hessianMultiplications, cold / 3);
    EXPECT_LE(relativeError(gathered(*again.multiplier), gathered(*solution.solution.multiplier)), 1e-7);
    solution.decomposition.data.scaleLoads(-2);
    scene::Scene other = scene;
    for (scene::Body& body : other.bodies)
      for (fem::SolidLoad& load : body.loads)
        load.value[0] *= -2;
    if (!coercive)
      continue; // it would be pulled off
    const ContactSolution changed = solution.solver.solve(solution.decomposition.data);
    const Solution fresh(other, parameters("no"));
    EXPECT_NEAR(changed.energy, fresh.solution.energy, 1e-8 * std::abs(fresh.solution.energy));
  }
}

TEST(AdaptiveConstraintsTest, TheReportCountsThem) {
  Solution solution(channels(true, 1e5, grid(3, 3)), parameters("auto", 10));
  const SolveFacts facts = solution.solver.facts();
  EXPECT_GT(facts.numAdaptiveConstraints, 0);
  EXPECT_NE(facts.preconditioner.find(std::to_string(facts.numAdaptiveConstraints) + " adaptive constraint"),
            std::string::npos);
  const Solution uniform(channels(true, 1, grid(3, 3)), parameters("auto", 10));
  EXPECT_EQ(uniform.solver.facts().numAdaptiveConstraints, 0);
  EXPECT_EQ(uniform.solver.facts().preconditioner.find("adaptive"), std::string::npos);
}

TEST(AdaptiveConstraintsTest, AutoNeedsAPreconditioner) {
  Teuchos::ParameterList list = parameters("auto", 10);
  list.sublist("Preconditioner").set("Type", "none");
  const scene::Scene scene = channels(true, 1e3, grid(2, 2));
  EXPECT_TRUE(Solution(scene, list).solver.dualProblem().deflatedOperator().is_null());
  list.sublist("Adaptive Constraints").set("Use", "yes");
  const Solution with(scene, list);
  EXPECT_FALSE(with.solver.dualProblem().deflatedOperator().is_null());
  EXPECT_LE(fieldError(with.field(), Solution(scene, parameters("no")).field()), 1e-8);
}

} // namespace
} // namespace epafi::fetidp
