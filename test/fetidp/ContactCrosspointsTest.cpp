#include "support/Preconditioned.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/precondition/ContactCrosspoints.hpp"

#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace epafi::fetidp {
namespace {

using Indices = std::vector<Eigen::Index>;

/// What the crosspoints are, and S_cc by dense elimination, on every rank.
struct Crosspoints {
  explicit Crosspoints(const scene::Scene& scene)
      : decomposition(decompose(scene, world())), problem(decomposition.problem),
        inverse(problem, DirectSolvers()), found(problem, inverse, problem.comm) {
    const Eigen::Index n = problem.crosspointMap->getGlobalNumElements();
    stiffness = Eigen::MatrixXd::Zero(n, n);
    isTouched = isNear = Eigen::VectorXd::Zero(n);
    bodyOf = Eigen::VectorXd::Zero(n);
    for (const auto& subdomain : problem.subdomains)
      add(subdomain);
    for (auto* values : {&isTouched, &bodyOf})
      for (double& value : *values)
        value = maxOverRanks(*problem.comm, value);
    sumOverRanks(*problem.comm, {stiffness.data(), static_cast<std::size_t>(stiffness.size())});
    for (Eigen::Index i = 0; i < n; ++i)
      (isTouched[i] > 0 ? touched : others).push_back(i);
    for (Eigen::Index i = 0; i < n; ++i)
      isNear[i] =
          std::any_of(touched.begin(), touched.end(), [&](Eigen::Index t) { return bodyOf[t] == bodyOf[i]; })
              ? 1
              : 0;
  }

  void add(const decomposition::Subdomain& subdomain) {
    const Eigen::MatrixXd k(*subdomain.stiffness);
    const auto &r = subdomain.remainderUnknowns, &c = subdomain.crosspointUnknowns;
    const Eigen::MatrixXd krr = k(r, r), krc = k(r, c);
    Eigen::MatrixXd s = k(c, c);
    if (!r.empty() && !c.empty())
      s -= krc.transpose() * direct::solvedSymmetric(krr, krc);
    const Indices indices(subdomain.crosspointIndices.begin(), subdomain.crosspointIndices.end());
    stiffness(indices, indices) += s;
    for (const auto& entry : subdomain.constraint)
      if (problem.numberOf(entry.multiplier) < problem.numInequalities) {
        const auto at = std::find(c.begin(), c.end(), entry.unknown);
        if (at != c.end())
          isTouched[indices[at - c.begin()]] = 1;
      }
    for (const Eigen::Index i : indices)
      bodyOf[i] = subdomain.body;
  }

  /// Schur complement of S_cc on the crosspoints that contact touches.
  [[nodiscard]] Eigen::MatrixXd schurComplement() const {
    Eigen::MatrixXd s = stiffness(touched, touched);
    if (!others.empty() && !touched.empty())
      s -= stiffness(touched, others) * response();
    return s;
  }
  /// S_oo⁻¹ S_ot: minus how the others follow. Regular, since every body is in contact or held.
  [[nodiscard]] Eigen::MatrixXd response() const {
    return direct::solvedSymmetric(stiffness(others, others), stiffness(others, touched));
  }

  model::Decomposition decomposition;
  const DecomposedProblem& problem;
  GeneralizedInverse inverse;
  ContactCrosspoints found;
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd isTouched, isNear, bodyOf; ///< by coarse unknown; > 0 if so
  Indices touched, others;                   ///< ascending
};

std::vector<ContactCase> crosspointCases() {
  std::vector<ContactCase> cases = contactCases();
  for (const bool coercive : {true, false}) {
    cases.push_back({"4x4", twoMembranes(coercive, 8, grid(4, 4)), coercive});
    cases.push_back({"three bodies", threeMembranes(!coercive, 8, grid(4, 2)), false});
  }
  return cases;
}

TEST(ContactCrosspointsTest, AreThoseThatContactTouches) {
  std::size_t most = 0;
  for (const ContactCase& c : crosspointCases()) {
    SCOPED_TRACE(c.name);
    const Crosspoints crosspoints(c.scene);
    const auto n = crosspoints.stiffness.rows();
    EXPECT_EQ(crosspoints.found.size(), static_cast<Eigen::Index>(crosspoints.touched.size()));
    int next = 0, nextNear = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      EXPECT_EQ(crosspoints.found.indexOf(i), crosspoints.isTouched[i] > 0 ? next++ : -1) << i;
      EXPECT_EQ(crosspoints.found.nearIndexOf(i), crosspoints.isNear[i] > 0 ? nextNear++ : -1) << i;
    }
    EXPECT_EQ(crosspoints.found.indexOf(n), -1);
    most = std::max(most, crosspoints.touched.size());
  }
  EXPECT_GE(most, 6U); // the cases have some
}

TEST(ContactCrosspointsTest, AreNoneWhereTheCutEndsAtNoContact) {
  const Crosspoints crosspoints(twoMembranes(true, 4, grid(1, 1)));
  EXPECT_EQ(crosspoints.found.size(), 0);
}

TEST(ContactCrosspointsTest, TheirStiffnessIsTheSchurComplementOfTheCoarseProblem) {
  for (const ContactCase& c : crosspointCases()) {
    const Crosspoints crosspoints(c.scene);
    if (crosspoints.problem.kernelDimension > 0 || crosspoints.touched.empty())
      continue;
    SCOPED_TRACE(c.name);
    EXPECT_LE(relativeError(crosspoints.found.stiffness(), crosspoints.schurComplement()), 1e-11);
  }
}

/// S_cc⁺ holds a floating body at as many places as it has rigid modes: that is what may be added, and
/// nothing else.
TEST(ContactCrosspointsTest, OnFloatingBodiesItIsThatAndAHoldOnTheRigidModes) {
  for (const ContactCase& c : crosspointCases()) {
    const Crosspoints crosspoints(c.scene);
    const int k = crosspoints.problem.kernelDimension;
    if (k == 0 || crosspoints.touched.empty())
      continue;
    SCOPED_TRACE(c.name);
    const Eigen::MatrixXd& s = crosspoints.found.stiffness();
    const Eigen::VectorXd added = direct::eigenOf(s - crosspoints.schurComplement()).values;
    const Eigen::Index n = s.rows();
    EXPECT_GT(added.minCoeff(), -1e-11 * s.norm());
    if (n > k) {
      EXPECT_LE(added[n - 1 - k], 1e-11 * s.norm());
    }
  }
}

TEST(ContactCrosspointsTest, TheirStiffnessIsSymmetricPositiveDefinite) {
  for (const ContactCase& c : crosspointCases()) {
    SCOPED_TRACE(c.name);
    const Crosspoints crosspoints(c.scene);
    const Eigen::MatrixXd& s = crosspoints.found.stiffness();
    EXPECT_EQ(s, s.transpose());
    if (s.rows() > 0) {
      EXPECT_GT(scaledSpectrum(s).minCoeff(), 1e-3);
    }
  }
}

/// Near crosspoints: those that are touched themselves stay with their values, the others go where no force
/// acts.
TEST(ContactCrosspointsTest, TheOthersFollowWithoutForce) {
  for (const ContactCase& c : crosspointCases()) {
    const Crosspoints crosspoints(c.scene);
    if (crosspoints.touched.empty())
      continue;
    SCOPED_TRACE(c.name);
    const Eigen::MatrixXd& extension = crosspoints.found.extension();
    const Eigen::Index numTouched = crosspoints.touched.size();
    for (Eigen::Index j = 0; j < numTouched; ++j)
      EXPECT_LE((extension.row(crosspoints.found.nearIndexOf(crosspoints.touched[j])) -
                 Eigen::RowVectorXd::Unit(numTouched, j))
                    .norm(),
                1e-12);
    if (crosspoints.problem.kernelDimension > 0 || crosspoints.others.empty())
      continue; // else a hold on rigid modes adds to it
    const Eigen::MatrixXd response = crosspoints.response();
    for (std::size_t i = 0; i < crosspoints.others.size(); ++i)
      if (const int near = crosspoints.found.nearIndexOf(crosspoints.others[i]); near >= 0) {
        EXPECT_LE((extension.row(near) + response.row(i)).norm(), 1e-12);
      }
  }
}

/// Bodies do not take each other along: coupling is left to the multipliers.
TEST(ContactCrosspointsTest, BodiesMoveByThemselves) {
  const Crosspoints crosspoints(threeMembranes(false, 8, grid(4, 2)));
  const Eigen::Index n = crosspoints.touched.size();
  ASSERT_GT(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      if (crosspoints.bodyOf[crosspoints.touched[i]] != crosspoints.bodyOf[crosspoints.touched[j]]) {
        EXPECT_LE(std::abs(crosspoints.found.stiffness()(i, j)), 1e-14);
      }
}

/// Averages of edges that end at another cluster follow the faces there, where no row touches them: each a
/// mean of jumps.
TEST(ContactCrosspointsTest, EdgesFollowTheFacesOfOtherClusters) {
  for (const ContactCase& c : clusteredCases()) {
    SCOPED_TRACE(c.name);
    const Crosspoints crosspoints(c.scene);
    std::vector<double> shares(crosspoints.stiffness.rows(), 0.0);
    for (const auto& subdomain : crosspoints.problem.subdomains)
      for (const decomposition::EdgeEnd& end : subdomain.edgeEnds) {
        shares[end.average] += end.share;
        EXPECT_EQ(crosspoints.found.follows(end.average), crosspoints.isTouched[end.average] == 0);
        EXPECT_GE(crosspoints.found.indexOf(end.average), 0);
      }
    sumOverRanks(*crosspoints.problem.comm, std::span(shares));
    int numFollowing = 0;
    for (const double share : shares)
      if (share != 0) {
        EXPECT_LE(share, 1 + 1e-14);
        EXPECT_GT(share, 0.7); // less than 1 where a support holds a node of the faces
        ++numFollowing;
      }
    EXPECT_EQ(numFollowing, 4); // one a cluster
    EXPECT_EQ(crosspoints.found.size(), static_cast<Eigen::Index>(crosspoints.touched.size()) + 4);
  }
}

/// Of clusters up to round-off: three and more subdomains share a row where their corners meet.
TEST(ContactCrosspointsTest, AreTheSameToTheLastDigitOnAnyNumberOfRanks) {
  std::vector<ContactCase> cases = crosspointCases();
  for (ContactCase& c : clusteredCases())
    cases.push_back(std::move(c));
  for (const ContactCase& c : cases) {
    SCOPED_TRACE(c.name);
    const Crosspoints together(c.scene);
    const auto decomposition = decompose(c.scene, thisRankOnly());
    GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
    const ContactCrosspoints alone(decomposition.problem, inverse, decomposition.problem.comm);
    ASSERT_EQ(together.found.size(), alone.size());
    const double allowed = c.scene.bodies.front().decomposition.cluster > 0 ? 1e-13 : 0;
    EXPECT_LE((together.found.stiffness() - alone.stiffness()).norm(), allowed * alone.stiffness().norm());
    EXPECT_LE((together.found.extension() - alone.extension()).norm(), allowed * alone.extension().norm());
  }
}

} // namespace
} // namespace epafi::fetidp
