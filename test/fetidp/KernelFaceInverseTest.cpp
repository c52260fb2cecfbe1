#include "support/Preconditioned.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/equilibrium/KernelFaceInverse.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

std::vector<ContactCase> cutCases() {
  std::vector<ContactCase> cases;
  for (ContactCase& c : contactCases()) // whole bodies
    if (!c.coercive)
      cases.push_back(std::move(c));
  for (ContactCase& c : clusteredCases())
    if (!c.coercive) // else supports hold all of them
      cases.push_back(std::move(c));
  for (const bool coercive : {true, false})
    cases.push_back({std::string(coercive ? "coercive" : "semicoercive") + ", a subdomain a cluster",
                     twoMembranes(coercive, 6, clustered(grid(3, 3), 1)), coercive});
  scene::Scene three = threeMembranes(true, 6, clustered(grid(2, 3), 2)); // two of them float
  cases.push_back({"three membranes", std::move(three), false});
  return cases;
}

/// Contact closed everywhere, at every third row, nowhere.
std::vector<RCP<Vector>> faces(const DecomposedProblem& problem) {
  std::vector<RCP<Vector>> result;
  for (const GlobalOrdinal step : {1, 3, 1000000}) {
    result.push_back(rcp(new Vector(problem.multiplierMap)));
    for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(*problem.multiplierMap)); ++row) {
      const bool isContact =
          problem.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::contact;
      const bool isFree = !isContact || (problem.multiplierMap->getGlobalElement(row) + 1) % step == 0;
      result.back()->replaceLocalValue(row, isFree ? 1.0 : 0.0);
    }
  }
  return result;
}

Eigen::MatrixXd matrixOf(const qp::FaceInverse& inverse, Eigen::Index size) {
  Eigen::MatrixXd matrix(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(size, j);
    inverse.apply({unit.data(), static_cast<std::size_t>(size)},
                  {matrix.col(j).data(), static_cast<std::size_t>(size)});
  }
  return matrix;
}

struct Cut {
  explicit Cut(const scene::Scene& scene, GramInverse::Form form = GramInverse::Form::automatic)
      : decomposition(decompose(scene, world())), problem(decomposition.problem),
        entries(kernelConstraint(problem)), space(problem, entries, form) {}

  /// G̃ on a face, dense.
  [[nodiscard]] Eigen::MatrixXd rows(const Eigen::VectorXd& face) const {
    Eigen::MatrixXd g(space.size(), face.size());
    for (Eigen::Index j = 0; j < face.size(); ++j)
      g.col(j) =
          face[j] * space.product(*spread(problem.multiplierMap, Eigen::VectorXd::Unit(face.size(), j)));
    return g;
  }

  model::Decomposition decomposition;
  const DecomposedProblem& problem;
  std::vector<KernelEntry> entries;
  NaturalCoarseSpace space;
};

qp::Face flat(const Vector& isFree) {
  qp::Face face(isFree.getMap());
  face.isFree.assign(isFree);
  return face;
}

TEST(KernelFaceInverseTest, IsAGeneralisedInverseOnEveryFace) {
  int numSingular = 0;
  for (const ContactCase& c : cutCases())
    for (const auto form : {GramInverse::Form::sparse, GramInverse::Form::spread}) {
      SCOPED_TRACE(c.name);
      const Cut cut(c.scene, form);
      const auto inverse = cut.space.faceInverse(cut.problem.multiplierMap);
      double ofWhole = 0; // the first face: elsewhere it may be round-off alone
      for (const RCP<Vector>& face : faces(cut.problem)) {
        inverse->setFace(flat(*face));
        const Eigen::MatrixXd g = cut.rows(gathered(*face)), n = g * g.transpose();
        const Eigen::MatrixXd found = matrixOf(*inverse, n.rows());
        ofWhole = ofWhole > 0 ? ofWhole : found.norm();
        EXPECT_LE((found - found.transpose()).norm(), 1e-10 * (found.norm() + ofWhole));
        EXPECT_LE((n * found * n - n).norm(), 1e-11 * n.norm());
        const Eigen::MatrixXd projector = g.transpose() * found * g;
        EXPECT_LE((projector * projector - projector).norm(), 1e-10);
        numSingular += direct::eigenOf(n).values[0] < 1e-10 ? 1 : 0;
      }
    }
  EXPECT_GE(numSingular, 3); // nothing closed under a floating body
}

/// A beam of many clusters, each with three motions, on another: where few contacts are left what holds the
/// face is tiny beside what holds the whole.
TEST(KernelFaceInverseTest, KeepsItsDigitsWhereFewContactsHoldManyClusters) {
  scene::Scene scene = twoMembranes(false, 2, clustered(grid(32, 1), 1));
  for (scene::Body& body : scene.bodies) {
    body.physics = fem::Physics::planeStrain;
    body.mesh.elements = {64, 2, 0};
    body.supports.clear();
  }
  scene.bodies[0].mesh.box = mesh::rectangle(0, 32, 0, 1);
  scene.bodies[1].mesh.box = mesh::rectangle(0, 32, 1, 2);
  scene.bodies[0].supports = {{"foot", "bottom", {0.0, 0.0}}};
  scene.bodies[1].supports = {{"stop", "left", {0.0, std::nullopt}}};
  scene.contacts = {{"joint", 0, "top", 1, "bottom", {}, 0.0}};
  for (const auto form : {GramInverse::Form::sparse, GramInverse::Form::spread}) {
    const Cut cut(scene, form);
    ASSERT_GT(cut.space.size(), 90);
    Vector face(cut.problem.multiplierMap);
    int numClosed = 0;
    for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(*cut.problem.multiplierMap)); ++row) {
      const bool isContact =
          cut.problem.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::contact;
      const GlobalOrdinal number = cut.problem.multiplierMap->getGlobalElement(row);
      const bool isClosed = isContact && (number == 3 || number == 4); // next to each other, near one end
      numClosed += isClosed ? 1 : 0;
      face.replaceLocalValue(row, !isContact || isClosed ? 1.0 : 0.0);
    }
    ASSERT_EQ(sumOverRanks(*world(), numClosed), 2);
    const auto inverse = cut.space.faceInverse(cut.problem.multiplierMap);
    inverse->setFace(flat(face));
    const RCP<Vector> x =
        spread(cut.problem.multiplierMap,
               randomVector(static_cast<Eigen::Index>(cut.problem.multiplierMap->getGlobalNumElements()), 7));
    x->elementWiseMultiply(1.0, face, *x, 0.0);
    const Eigen::VectorXd before = cut.space.product(*x);
    Eigen::VectorXd alpha(before.size());
    const std::size_t size = before.size();
    inverse->apply({before.data(), size}, {alpha.data(), size});
    Vector image(cut.problem.multiplierMap);
    cut.space.addTransposedProduct({alpha.data(), size}, 1.0, image);
    image.elementWiseMultiply(1.0, face, image, 0.0);
    x->update(-1.0, image, 1.0); // P_F x
    EXPECT_LE(cut.space.product(*x).norm(), 1e-12 * before.norm());
  }
}

/// Where nothing asks for it no body moves: a body that is one cluster not at all, the clusters of one not at
/// as many modes as it has.
TEST(KernelFaceInverseTest, LeavesBodiesThatAreFreeAtRest) {
  for (const bool isWhole : {true, false}) {
    const Cut cut(twoMembranes(false, 6, isWhole ? grid(3, 3) : clustered(grid(3, 3), 1)));
    const auto inverse = cut.space.faceInverse(cut.problem.multiplierMap);
    inverse->setFace(flat(*faces(cut.problem).back()));
    const Eigen::VectorXd load = kernelLoad(cut.problem, cut.decomposition.data);
    Eigen::VectorXd motion(load.size());
    inverse->apply({load.data(), static_cast<std::size_t>(load.size())},
                   {motion.data(), static_cast<std::size_t>(motion.size())});
    if (isWhole)
      EXPECT_LE(motion.norm(), 1e-10 * load.norm());
    else
      EXPECT_LE(motion.cwiseAbs().minCoeff(), 1e-10 * motion.norm());
  }
}

TEST(KernelGramTest, IsTheProductOfTheRowsOnAnyNumberOfRanks) {
  for (const ContactCase& c : cutCases()) {
    SCOPED_TRACE(c.name);
    const Cut cut(c.scene);
    const int ranks = cut.problem.comm->getSize();
    const Eigen::MatrixXd gram(kernelGram(cut.problem, cut.entries, RankGroups(cut.problem.comm, ranks)));
    const RankGroups half(cut.problem.comm, (ranks + 1) / 2);
    const Eigen::MatrixXd ofLeaders(kernelGram(cut.problem, cut.entries, half));
    EXPECT_EQ((ofLeaders - (half.leads() ? gram : Eigen::MatrixXd::Zero(gram.rows(), gram.cols()))).norm(),
              0);
    const ContactGram contact(cut.problem, cut.entries);
    const DenseProblem dense = densify(cut.problem);
    const Eigen::MatrixXd gt = dense.constraint * dense.kernel; // G̃ᵀ
    const auto lower = [](const Eigen::MatrixXd& m) {
      return Eigen::MatrixXd(m.triangularView<Eigen::Lower>());
    };
    const auto cutAlone = decompose(c.scene, thisRankOnly());
    const Eigen::MatrixXd alone(
        kernelGram(cutAlone.problem, kernelConstraint(cutAlone.problem), RankGroups(thisRankOnly(), 1)));
    EXPECT_LE((gram - alone).norm(), 1e-14 * gt.squaredNorm());
    for (const RCP<Vector>& face : faces(cut.problem)) {
      const Eigen::VectorXd isOff = Eigen::VectorXd::Ones(gt.rows()) - gathered(*face);
      const Eigen::MatrixXd expected = gt.transpose() * isOff.asDiagonal() * gt;
      Eigen::MatrixXd found = Eigen::MatrixXd::Zero(gt.cols(), gt.cols());
      found(contact.modes(), contact.modes()) = contact.offFace(flat(*face));
      EXPECT_LE((found - expected).norm(), 1e-13 * gt.squaredNorm());
    }
    EXPECT_LE((gram - lower(gt.transpose() * gt)).norm(), 1e-13 * gt.squaredNorm());
  }
}

} // namespace
} // namespace epafi::fetidp
