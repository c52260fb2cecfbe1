#include "support/Preconditioned.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace epafi::fetidp {
namespace {

using decomposition::Subdomain;

std::vector<ContactCase> allCases() {
  std::vector<ContactCase> cases = contactCases();
  for (const auto& more : {clusteredCases(), hardCases(), jumpsInside()})
    cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

/// Where the conductivity jumps inside a subdomain, multiplicity scaling lets the softest value decide, and
/// what follows crosspoints on one side of the jump may be far stiffer than on the other.
double smallestEigenvalue(const PreconditionerParameters& parameters) {
  return parameters.scaling == Scaling::stiffness ? 1e-7 : 1e-8;
}

TEST(DualPreconditionerTest, IsSymmetricPositiveDefinite) {
  for (const ContactCase& c : allCases())
    for (const PreconditionerParameters& parameters : allPreconditioners(false)) {
      SCOPED_TRACE(c.name + "; " + describe(parameters));
      const Eigen::MatrixXd m = matrixOf(Preconditioned(c.scene, parameters).m);
      ASSERT_GT(m.diagonal().minCoeff(), 0);
      EXPECT_LE(scaledAsymmetry(m), 1e-11);
      EXPECT_GT(scaledSpectrum(m).minCoeff(), smallestEigenvalue(parameters));
    }
}

TEST(DualPreconditionerTest, InSinglePrecisionItIsSymmetricPositiveDefiniteToSixDigits) {
  for (const ContactCase& c : allCases())
    for (PreconditionerParameters parameters : allPreconditioners(true)) {
      SCOPED_TRACE(c.name + "; " + describe(parameters));
      const Eigen::MatrixXd m = matrixOf(Preconditioned(c.scene, parameters).m);
      ASSERT_GT(m.diagonal().minCoeff(), 0);
      EXPECT_LE(scaledAsymmetry(m), 1e-6);
      EXPECT_GT(scaledSpectrum(m).minCoeff(), smallestEigenvalue(parameters));
      parameters.isSingle = false;
      const double error = relativeError(m, matrixOf(Preconditioned(c.scene, parameters).m));
      EXPECT_LE(error, 1e-6);
    }
}

/// Eᵀ S̃ E by dense algebra: E takes multipliers to displacements, S̃ is a stiffness.
class DensePreconditioner {
public:
  DensePreconditioner(const Preconditioned& p, const PreconditionerParameters& parameters)
      : problem_(p.problem), parameters_(parameters), crosspoints_(problem_, *p.inverse, problem_.comm),
        diagonal_(
            Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem_.crosspointMap->getGlobalNumElements()))),
        totals_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem_.dualDimension()))) {
    for (const Subdomain& s : problem_.subdomains)
      for (std::size_t c = 0; c < s.crosspointUnknowns.size(); ++c)
        diagonal_[s.crosspointIndices[c]] +=
            s.stiffness->coeff(s.crosspointUnknowns[c], s.crosspointUnknowns[c]);
    sum(diagonal_);
    for (const Subdomain& s : problem_.subdomains)
      for (const auto& entry : s.constraint)
        if (isOwn(s, entry))
          totals_[row(entry)] += entry.coefficient * entry.coefficient / weight(s, entry.unknown);
    sum(totals_);
    shares_ = Eigen::VectorXd::Zero(totals_.size());
    for (const Subdomain& s : problem_.subdomains)
      for (const auto& entry : s.constraint)
        if (std::binary_search(s.remainderUnknowns.begin(), s.remainderUnknowns.end(), entry.unknown))
          shares_[row(entry)] += entry.coefficient * scaled(s, entry);
    sum(shares_);
  }

  [[nodiscard]] Eigen::MatrixXd matrix() const {
    const Eigen::Index n = totals_.size();
    Eigen::MatrixXd touched = Eigen::MatrixXd::Zero(crosspoints_.size(), n); // B_Dᵀ at crosspoints
    for (const Subdomain& s : problem_.subdomains)
      for (std::size_t c = 0; c < s.crosspointUnknowns.size(); ++c)
        for (const auto& entry : s.constraint)
          if (entry.unknown == s.crosspointUnknowns[c])
            touched(crosspoints_.indexOf(s.crosspointIndices[c]), row(entry)) += scaled(s, entry);
    for (const Subdomain& s : problem_.subdomains)
      for (const decomposition::EdgeEnd& end : s.edgeEnds)
        for (const auto& entry : s.constraint)
          if (entry.unknown == end.unknown && crosspoints_.follows(end.average))
            touched(crosspoints_.indexOf(end.average), row(entry)) += end.share * scaled(s, entry);
    sum(touched);
    Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(n, n); // J C
    for (const Subdomain& s : problem_.subdomains)
      addJumps(s, touched, jumps);
    sum(jumps);
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) - jumps;
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    for (const Subdomain& s : problem_.subdomains)
      addSubdomain(s, left, m);
    sum(m);
    m += touched.transpose() * crosspoints_.stiffness() * touched;
    for (Eigen::Index i = 0; i < n; ++i)
      if (totals_[i] == 0)
        m(i, i) = 1;
    return m;
  }

private:
  /// How its boundary follows the crosspoints, −B_Δ Ψ_Δ X C, in shares.
  void addJumps(const Subdomain& s, const Eigen::MatrixXd& touched, Eigen::MatrixXd& jumps) const {
    if (crosspoints_.size() == 0)
      return;
    const Eigen::MatrixXd k(*s.stiffness);
    const auto &r = s.remainderUnknowns, &c = s.crosspointUnknowns;
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(c.size()), jumps.cols());
    for (std::size_t j = 0; j < c.size(); ++j)
      if (const int near = crosspoints_.nearIndexOf(s.crosspointIndices[j]); near >= 0)
        moved.row(j) = crosspoints_.extension().row(near) * touched;
    const Eigen::MatrixXd krc = k(r, c);
    const Eigen::MatrixXd follow = -direct::solvedSymmetric(k(r, r), krc * moved);
    for (const auto& entry : s.constraint)
      if (const auto at = std::lower_bound(r.begin(), r.end(), entry.unknown);
          at != r.end() && *at == entry.unknown)
        jumps.row(row(entry)) += entry.coefficient / shares_[row(entry)] * follow.row(at - r.begin());
  }

  void addSubdomain(const Subdomain& s, const Eigen::MatrixXd& left, Eigen::MatrixXd& m) const {
    const Eigen::MatrixXd k(*s.stiffness);
    const auto& r = s.remainderUnknowns;
    const std::vector<int> boundary = interfaceOf(s).boundary;
    if (boundary.empty())
      return;
    const Eigen::MatrixXd krr = k(r, r), inverse = direct::inverseOfSpd(krr);
    const Eigen::MatrixXd stiffness = parameters_.type == Type::lumped
                                          ? Eigen::MatrixXd(krr(boundary, boundary))
                                          : direct::inverseOfSpd(inverse(boundary, boundary));
    Eigen::MatrixXd t = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(boundary.size()), m.cols());
    for (std::size_t i = 0; i < boundary.size(); ++i)
      for (const auto& entry : s.constraint)
        if (entry.unknown == r[boundary[i]])
          t.row(i) += scaled(s, entry) * left.row(row(entry));
    m += t.transpose() * stiffness * t;
  }

  [[nodiscard]] Eigen::Index row(const decomposition::ConstraintEntry& entry) const {
    return static_cast<Eigen::Index>(problem_.numberOf(entry.multiplier));
  }
  [[nodiscard]] double weight(const Subdomain& s, int unknown) const {
    if (parameters_.scaling == Scaling::multiplicity)
      return 1.0;
    for (std::size_t c = 0; c < s.crosspointUnknowns.size(); ++c)
      if (s.crosspointUnknowns[c] == unknown)
        return diagonal_[s.crosspointIndices[c]];
    return s.stiffness->coeff(unknown, unknown);
  }
  /// Whether no other row of contact acts on the unknown.
  [[nodiscard]] bool isOwn(const Subdomain& s, const decomposition::ConstraintEntry& entry) const {
    const auto isGluing = [&](const auto& other) {
      return problem_.kindOf(other.multiplier) == decomposition::RowKind::gluing;
    };
    return isGluing(entry) || std::count_if(s.constraint.begin(), s.constraint.end(), [&](const auto& other) {
                                return !isGluing(other) && other.unknown == entry.unknown;
                              }) == 1;
  }
  /// An entry of B_D.
  [[nodiscard]] double scaled(const Subdomain& s, const decomposition::ConstraintEntry& entry) const {
    return isOwn(s, entry) ? entry.coefficient / weight(s, entry.unknown) / totals_[row(entry)] : 0.0;
  }
  template <class Matrix>
  void sum(Matrix& matrix) const {
    sumOverRanks(*problem_.comm, {matrix.data(), static_cast<std::size_t>(matrix.size())});
  }

  const DecomposedProblem& problem_;
  PreconditionerParameters parameters_;
  ContactCrosspoints crosspoints_;
  Eigen::VectorXd diagonal_; ///< of K̄ at the crosspoints
  Eigen::VectorXd totals_;   ///< Σ b²/δ of each row
  Eigen::VectorXd shares_;   ///< Σ b B_D of each row over the boundaries
};

TEST(DualPreconditionerTest, IsTheSumOfScaledStiffnessesThatItsDefinitionSays) {
  for (const ContactCase& c : allCases())
    for (const PreconditionerParameters& parameters : allPreconditioners(false)) {
      SCOPED_TRACE(c.name + "; " + describe(parameters));
      const Preconditioned preconditioned(c.scene, parameters);
      EXPECT_LE(
          relativeError(matrixOf(preconditioned.m), DensePreconditioner(preconditioned, parameters).matrix()),
          1e-9);
    }
}

TEST(DualPreconditionerTest, RowsThatTouchNothingAreLeftAlone) {
  const std::string name = "contact that ends at both bodies' supports";
  for (const ContactCase& c : hardCases())
    if (c.name == name)
      for (const PreconditionerParameters& parameters : allPreconditioners(true)) {
        const Preconditioned preconditioned(c.scene, parameters);
        const Eigen::MatrixXd f = matrixOf(preconditioned.f), m = matrixOf(preconditioned.m);
        int untouched = 0;
        for (Eigen::Index i = 0; i < f.rows(); ++i)
          if (f.row(i).isZero(0)) {
            ++untouched;
            EXPECT_EQ(m.row(i), Eigen::RowVectorXd::Unit(f.rows(), i));
          }
        EXPECT_EQ(untouched, 1); // the end at the feet; the other one is free
        const Eigen::VectorXd spectrum = scaledSpectrum(m);
        EXPECT_GT(spectrum.minCoeff(), 1e-3);
      }
}

/// Where corners of several clusters meet, three and more subdomains share a row: the same up to round-off.
TEST(DualPreconditionerTest, IsTheSameToTheLastDigitOnAnyNumberOfRanks) {
  for (const ContactCase& c : allCases())
    for (const bool isSingle : {false, true}) {
      SCOPED_TRACE(c.name + (isSingle ? ", single" : ""));
      const PreconditionerParameters parameters{Type::dirichlet, Scaling::stiffness, isSingle};
      const Eigen::MatrixXd together = matrixOf(Preconditioned(c.scene, parameters).m);
      const Eigen::MatrixXd alone = matrixOf(Preconditioned(c.scene, parameters, thisRankOnly()).m);
      const bool isCut = c.scene.bodies.front().decomposition.cluster > 0;
      EXPECT_LE((together - alone).cwiseAbs().maxCoeff(), isCut ? 1e-14 * alone.cwiseAbs().maxCoeff() : 0);
    }
}

TEST(DualPreconditionerTest, ABodyWithoutContactLeavesTheOthersAlone) {
  scene::Scene scene = twoMembranes(true, 6, grid(3, 3));
  const Eigen::MatrixXd two = matrixOf(Preconditioned(scene).m);
  scene.bodies.push_back(scene.bodies.back()); // its subdomains are identical to those of a body with contact
  scene.bodies.back().name = "alone";
  scene.bodies.back().mesh.box = mesh::rectangle(5, 6, 0, 1);
  const Eigen::MatrixXd three = matrixOf(Preconditioned(scene).m);
  ASSERT_GT(three.rows(), two.rows());
  EXPECT_LE(relativeError(three.topLeftCorner(two.rows(), two.cols()), two), 1e-12); // its rows come last
  EXPECT_LE(three.topRightCorner(two.rows(), three.cols() - two.cols()).cwiseAbs().maxCoeff(), 0);
}

TEST(DualPreconditionerTest, ScalesAndAddsAsTpetraOperatorsDo) {
  const Preconditioned preconditioned(twoMembranes(true, 4, grid(2, 2)));
  const Eigen::MatrixXd m = matrixOf(preconditioned.m);
  const Eigen::VectorXd x = randomVector(m.rows(), 1), y = randomVector(m.rows(), 2);
  const RCP<const Map> map = preconditioned.m.getDomainMap();
  const RCP<Vector> input = spread(map, x), output = spread(map, y);

  preconditioned.m.apply(*input, *output, Teuchos::NO_TRANS, 2.0, -3.0);
  EXPECT_LE(relativeError(gathered(*output), 2.0 * m * x - 3.0 * y), 1e-13);
  output->putScalar(std::numeric_limits<double>::quiet_NaN());
  preconditioned.m.apply(*input, *output, Teuchos::TRANS); // beta = 0 forgets what was there
  EXPECT_LE(relativeError(gathered(*output), m * x), 1e-13);
  EXPECT_EQ(gathered(*input), x);
}

TEST(DualPreconditionerTest, ItsUnitsAreThoseOfTheStiffness) {
  for (const PreconditionerParameters& parameters : allPreconditioners(false)) {
    SCOPED_TRACE(describe(parameters));
    scene::Scene scene = twoMembranes(false, 6, grid(3, 3));
    const Eigen::MatrixXd m = matrixOf(Preconditioned(scene, parameters).m);
    for (scene::Body& body : scene.bodies)
      body.material.conductivity *= 1024;
    EXPECT_LE(relativeError(matrixOf(Preconditioned(scene, parameters).m), 1024 * m), 1e-14);
  }
}

TEST(DualPreconditionerTest, SinglePrecisionReadsHalfTheBytesAtMost) {
  const scene::Scene scene = twoMembranes(false, 12, grid(4, 4));
  const Preconditioned full(scene, {Type::lumped, Scaling::stiffness, false}, thisRankOnly()),
      single(scene, {Type::lumped, Scaling::stiffness, true}, thisRankOnly());
  EXPECT_GT(full.m.bytes(), 0U);
  EXPECT_EQ(single.m.bytes(), full.m.bytes() / 2);
}

} // namespace
} // namespace epafi::fetidp
