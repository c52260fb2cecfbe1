#include "support/Gathered.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

namespace epafi::decomposition {
namespace {

bool haveEqualBits(const SparseMatrix& a, const SparseMatrix& b) {
  const auto same = [](const auto* x, const auto* y, Eigen::Index size) {
    return std::memcmp(x, y, sizeof(*x) * static_cast<std::size_t>(size)) == 0;
  };
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         same(a.outerIndexPtr(), b.outerIndexPtr(), a.outerSize() + 1) &&
         same(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) &&
         same(a.valuePtr(), b.valuePtr(), a.nonZeros());
}

/// All subdomains, on one rank.
Decomposition decomposedAlone(const scene::Scene& scene) {
  return decompose(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
}

TEST(EqualSubdomainsTest, InnerSubdomainsOfAUniformMeshAreEqualToTheLastBit) {
  for (const mesh::Box& rectangle :
       {mesh::rectangle(0, 1, 0, 1), mesh::rectangle(0.1, 0.8, -3.3, 1.1), mesh::rectangle(100, 101, 7, 9)}) {
    scene::Scene scene = oneBody(30, 30, grid(5, 5), {{"wall", "left", {0.3}}});
    scene.bodies[0].mesh.box = rectangle; // 1/30 is no binary fraction
    const auto result = decomposedAlone(scene);
    const std::vector<Subdomain>& s = result.problem.subdomains;
    ASSERT_EQ(s.size(), 25u);
    for (const std::size_t row : {1U, 2U, 3U})
      for (const std::size_t column : {1U, 2U, 3U}) {
        EXPECT_TRUE(haveEqualBits(*s[6].stiffness, *s[5 * row + column].stiffness)) << row << ' ' << column;
        EXPECT_EQ(s[6].unknownPosition, s[5 * row + column].unknownPosition);
      }
    // Supports and free edges do not disturb those who do not touch them, nor those who touch the same.
    EXPECT_TRUE(haveEqualBits(*s[6].stiffness, *s[24].stiffness));
    EXPECT_TRUE(haveEqualBits(*s[5].stiffness, *s[15].stiffness));
    EXPECT_FALSE(haveEqualBits(*s[5].stiffness, *s[6].stiffness));
  }
}

TEST(EqualSubdomainsTest, EqualMatricesAreStoredOnce) {
  const auto result = decomposedAlone(oneBody(30, 30, grid(5, 5), {{"wall", "left", {0.3}}}));
  std::set<const SparseMatrix*> stored;
  for (const Subdomain& s : result.problem.subdomains)
    stored.insert(s.stiffness.get());
  EXPECT_EQ(stored.size(), 2u); // with the support, and without
}

TEST(EqualSubdomainsTest, UnevenGridsHaveAsManyMatricesAsShapes) {
  const auto result = decomposedAlone(oneBody(31, 23, grid(5, 4), {})); // widths 6 and 7, heights 5 and 6
  std::map<Eigen::Index, std::vector<const SparseMatrix*>> ofSize;
  std::size_t different = 0;
  for (const Subdomain& s : result.problem.subdomains) {
    auto& known = ofSize[s.stiffness->rows()];
    if (std::none_of(known.begin(), known.end(),
                     [&](const SparseMatrix* other) { return haveEqualBits(*other, *s.stiffness); })) {
      known.push_back(s.stiffness.get());
      ++different;
    }
  }
  EXPECT_EQ(different, 4u);
}

TEST(EqualSubdomainsTest, AnotherMaterialMakesAnotherMatrixOfTheSamePattern) {
  scene::Scene scene = oneBody(30, 30, grid(5, 5), {});
  scene.bodies[0].regions = {{"middle", mesh::rectangle(0.4, 0.6, 0.4, 0.6), "", {10}}};
  const auto result = decomposedAlone(scene);
  const std::vector<Subdomain>& s = result.problem.subdomains;
  EXPECT_FALSE(haveEqualBits(*s[12].stiffness, *s[6].stiffness));
  EXPECT_LT((Eigen::MatrixXd(*s[12].stiffness) - 10 * Eigen::MatrixXd(*s[6].stiffness)).cwiseAbs().maxCoeff(),
            1e-13);
  EXPECT_TRUE(haveEqualBits(*s[11].stiffness, *s[6].stiffness));
}

} // namespace
} // namespace epafi::decomposition
