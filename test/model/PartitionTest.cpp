#include "support/Gathered.hpp"
#include "support/Refusal.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fem/LocalNumbering.hpp"
#include "epafi/mesh/BracedElements.hpp"
#include "epafi/mesh/MeshOrder.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace epafi::decomposition {
namespace {

mesh::StructuredMesh boxMesh(int nx, int ny, int nz) {
  return {{{0, 0, 0}, {1, 1, 1}}, {nx, ny, nz}};
}

std::vector<int> partsOf(const Partition& partition, const mesh::Mesh& mesh) {
  std::vector<int> parts(mesh.numElements());
  for (std::size_t element = 0; element < parts.size(); ++element)
    parts[element] = partition.partOf(static_cast<GlobalOrdinal>(element));
  return parts;
}

/// Number of parts that have elements; each of them connected.
int expectConnected(const mesh::Mesh& mesh, const std::vector<int>& part) {
  std::set<int> begun;
  std::vector<char> seen(part.size(), 0);
  std::vector<GlobalOrdinal> neighbours;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (seen[seed] != 0)
      continue;
    EXPECT_TRUE(begun.insert(part[seed]).second) << "part " << part[seed] << " is not connected";
    std::vector<GlobalOrdinal> stack{static_cast<GlobalOrdinal>(seed)};
    seen[seed] = 1;
    while (!stack.empty()) {
      mesh.elementNeighbours(stack.back(), neighbours);
      stack.pop_back();
      for (const GlobalOrdinal other : neighbours)
        if (part[other] == part[seed] && seen[other]++ == 0)
          stack.push_back(other);
    }
  }
  return static_cast<int>(begun.size());
}

/// Every element is in exactly one part, as both queries say, and every part is non-empty and connected.
void expectSound(const Partition& partition, const mesh::Mesh& mesh) {
  EXPECT_EQ(expectConnected(mesh, partsOf(partition, mesh)), partition.numParts());
  GlobalOrdinal total = 0;
  for (int part = 0; part < partition.numParts(); ++part) {
    const std::vector<GlobalOrdinal> elements = partition.elementsOf(part);
    EXPECT_TRUE(std::is_sorted(elements.begin(), elements.end()));
    for (const GlobalOrdinal element : elements)
      EXPECT_EQ(partition.partOf(element), part);
    total += std::ssize(elements);
  }
  EXPECT_EQ(total, mesh.numElements());
}

TEST(PartitionTest, GridsCutBoxesXFirstThenYThenZ) {
  const mesh::StructuredMesh mesh = boxMesh(4, 3, 2);
  const GridPartition partition(mesh, {2, 3, 2});
  EXPECT_EQ(partition.numParts(), 12);
  EXPECT_EQ(partition.elementsOf(0), (std::vector<GlobalOrdinal>{0, 1}));
  EXPECT_EQ(partition.elementsOf(1), (std::vector<GlobalOrdinal>{2, 3}));
  EXPECT_EQ(partition.elementsOf(2), (std::vector<GlobalOrdinal>{4, 5}));
  EXPECT_EQ(partition.elementsOf(6), (std::vector<GlobalOrdinal>{12, 13}));
  EXPECT_EQ(partition.elementsOf(11), (std::vector<GlobalOrdinal>{22, 23}));
  EXPECT_EQ(GridPartition(mesh, {1, 1, 2}).elementsOf(1),
            (std::vector<GlobalOrdinal>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
}

/// Rectangles have no third count.
TEST(PartitionTest, GridsCutIntoEqualPartsThatCoverTheBody) {
  for (const auto& size : {std::array{8, 8, 0}, {7, 5, 0}, {3, 11, 0}, {6, 6, 6}, {7, 5, 4}, {3, 8, 5}})
    for (const auto& most : {std::array{1, 1, 1}, {2, 2, 2}, {3, 5, 4}, {3, 1, 2}, {1, 4, 1}}) {
      const mesh::StructuredMesh mesh = boxMesh(size[0], size[1], size[2]);
      const std::array counts{most[0], most[1], size[2] == 0 ? 1 : most[2]};
      const GridPartition partition(mesh, counts);
      ASSERT_EQ(partition.numParts(), counts[0] * counts[1] * counts[2]);
      expectSound(partition, mesh);
      int least = 1, largest = 1;
      for (std::size_t d = 0; d < 3; ++d) {
        least *= std::max(size[d], 1) / counts[d];
        largest *= (std::max(size[d], 1) + counts[d] - 1) / counts[d];
      }
      for (int part = 0; part < partition.numParts(); ++part) {
        EXPECT_GE(std::ssize(partition.elementsOf(part)), least);
        EXPECT_LE(std::ssize(partition.elementsOf(part)), largest);
      }
    }
}

TEST(PartitionTest, OneLayerIsCutAsARectangle) {
  const mesh::StructuredMesh rectangle(mesh::rectangle(0, 1, 0, 1), {7, 5, 0});
  const GridPartition flat(rectangle, {3, 2, 1}), solid(boxMesh(7, 5, 1), {3, 2, 1});
  ASSERT_EQ(solid.numParts(), flat.numParts());
  for (int part = 0; part < flat.numParts(); ++part)
    EXPECT_EQ(solid.elementsOf(part), flat.elementsOf(part));
  for (GlobalOrdinal element = 0; element < rectangle.numElements(); ++element)
    EXPECT_EQ(solid.partOf(element), flat.partOf(element));
}

/// Numberings that are different from each other, and how often each of them was found.
std::vector<std::pair<fem::LocalNumbering, int>> numberingsOf(const Partition& partition,
                                                              const mesh::Mesh& mesh) {
  std::vector<std::pair<fem::LocalNumbering, int>> known;
  for (int part = 0; part < partition.numParts(); ++part) {
    const std::vector<GlobalOrdinal> elements = partition.elementsOf(part);
    std::vector<GlobalOrdinal> corners(8 * elements.size());
    mesh.elementNodes(elements, corners);
    auto found = std::find_if(known.begin(), known.end(), [&](const auto& entry) {
      return entry.first.firstNodeIfShifted(corners).has_value();
    });
    if (found == known.end())
      found = known.insert(known.end(), {fem::LocalNumbering(corners, 8), 0});
    ++found->second;
    const GlobalOrdinal first = *std::min_element(corners.begin(), corners.end());
    EXPECT_EQ(found->first.firstNodeIfShifted(corners), first) << part;
    const std::vector<GlobalOrdinal> nodes = found->first.nodes(first);
    for (std::size_t c = 0; c < corners.size(); ++c)
      EXPECT_EQ(nodes[found->first.corners()[c]], corners[c]);
  }
  return known;
}

TEST(PartitionTest, EqualBoxesOfAMeshAreNumberedAlike) {
  const mesh::StructuredMesh mesh = boxMesh(6, 9, 8);
  const auto equal = numberingsOf(GridPartition(mesh, {2, 3, 4}), mesh);
  ASSERT_EQ(equal.size(), 1u);
  EXPECT_EQ(equal[0].second, 24);
  EXPECT_EQ(equal[0].first.numNodes(), 4u * 4 * 3);
  EXPECT_EQ(equal[0].first.numElements(), 3u * 3 * 2);
  // Two widths, two depths, two heights.
  EXPECT_EQ(numberingsOf(GridPartition(mesh, {4, 4, 3}), mesh).size(), 8u);
}

TEST(PartitionTest, GraphPartsAreConnectedAndCoverTheBody) {
  const mesh::StructuredMesh mesh(mesh::rectangle(0, 1, 0, 1), {13, 9, 0});
  for (const int parts : {1, 2, 3, 7, 16, 40, 117}) {
    const GraphPartition partition(mesh, parts, *world());
    EXPECT_LE(partition.numParts(), parts);
    // METIS leaves parts empty when few elements are left for each; with three or more it does not waste half
    // of them.
    EXPECT_GE(partition.numParts(), parts <= 40 ? (parts + 1) / 2 : 40);
    expectSound(partition, mesh);
  }
}

TEST(PartitionTest, GraphPartsAreTheSameOnEveryRank) {
  const mesh::StructuredMesh mesh(mesh::rectangle(0, 1, 0, 1), {13, 9, 0});
  const GraphPartition partition(mesh, 7, *world());
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const double part = partition.partOf(element);
    EXPECT_EQ(maxOverRanks(*world(), part), minOverRanks(*world(), part));
  }
}

/// The largest number of elements of a part over the mean.
double imbalanceOf(const Partition& partition) {
  double largest = 0, sum = 0;
  for (int part = 0; part < partition.numParts(); ++part) {
    const auto size = static_cast<double>(partition.elementsOf(part).size());
    largest = std::max(largest, size);
    sum += size;
  }
  return largest * partition.numParts() / sum;
}

TEST(PartitionTest, GraphPartsOfBoxesAreConnectedAndBalanced) {
  for (const auto& size : {std::array{12, 12, 12}, {20, 9, 5}, {31, 30, 1}}) {
    const mesh::StructuredMesh mesh = boxMesh(size[0], size[1], size[2]);
    for (const int parts : {1, 2, 5, 8, 13}) {
      const GraphPartition partition(mesh, parts, *world());
      EXPECT_EQ(partition.numParts(), parts);
      expectSound(partition, mesh);
      EXPECT_LE(imbalanceOf(partition), 1.1) << size[0] << ' ' << parts;
    }
  }
  const mesh::StructuredMesh tiny = boxMesh(3, 3, 3);
  for (const int parts : {1, 2, 9, 20, 27})
    expectSound(GraphPartition(tiny, parts, *world()), tiny);
}

TEST(PartitionTest, GraphPartsDoNotDependOnTheNumberOfRanks) {
  const Teuchos::MpiComm<int> alone(MPI_COMM_SELF);
  const mesh::StructuredMesh mesh = boxMesh(9, 8, 7);
  EXPECT_EQ(partsOf(GraphPartition(mesh, 6, *world()), mesh), partsOf(GraphPartition(mesh, 6, alone), mesh));
}

/// Through edges in the plane and faces in space; a stray element goes where most of them are.
TEST(PartitionTest, PartsInManyPiecesAreMadeConnected) {
  for (const auto& [nx, ny, nz] : {std::array{12, 11, 0}, {5, 4, 6}}) {
    const mesh::StructuredMesh mesh = boxMesh(nx, ny, nz);
    const auto size = static_cast<int>(mesh.numElements());
    std::vector<int> checkerboard, stripes, scattered, halves;
    for (int e = 0; e < size; ++e) {
      const int x = e % nx, y = e / nx % ny, z = e / nx / ny;
      checkerboard.push_back((x + y + z) % 2);
      stripes.push_back(y % 2);
      scattered.push_back(e * 7919 % 13 * (e % 5) % 6);
      halves.push_back(nz > 0 ? (2 * z < nz ? 0 : 1) : (2 * x < nx ? 0 : 1));
    }
    for (std::vector<int>* part : {&checkerboard, &stripes, &scattered}) {
      meshing::makeConnected(mesh, *part);
      EXPECT_GE(expectConnected(mesh, *part), 1);
    }
    std::vector<int> withStray = halves;
    withStray[2 + nx * (nz > 0 ? 1 + ny : 5)] = 1;
    meshing::makeConnected(mesh, withStray);
    EXPECT_EQ(withStray, halves);
  }
}

TEST(PartitionTest, BoxesThatTouchInAnEdgeOrACornerAreNotConnected) {
  std::vector<int> edge{0, 1, 1, 1, 1, 1, 0, 1}, corner{0, 1, 1, 1, 1, 1, 1, 0}; // part 0 is two of 2 × 2 × 2
  for (std::vector<int>* part : {&edge, &corner}) {
    meshing::makeConnected(boxMesh(2, 2, 2), *part);
    EXPECT_EQ(*part, (std::vector<int>{0, 1, 1, 1, 1, 1, 1, 1})); // of equal pieces, the first one stays
  }
}

TEST(PartitionTest, BodiesThatAreMeshedAndCutAlikeShareTheirPartition) {
  scene::Scene scene = twoMembranes(true, 9, metis(7));
  const auto alike = decompose(scene, world());
  EXPECT_EQ(alike.bodies[0].partition, alike.bodies[1].partition);
  scene.bodies[1].decomposition = metis(6);
  const auto different = decompose(scene, world());
  EXPECT_NE(different.bodies[0].partition, different.bodies[1].partition);
  scene.bodies[1].decomposition = grid(3, 3);
  EXPECT_EQ(decompose(scene, world()).bodies[1].partition->numParts(), 9);
}

TEST(PartitionTest, ImpossibleCountsAreRefused) {
  const mesh::StructuredMesh mesh(mesh::rectangle(0, 1, 0, 1), {3, 2, 0});
  EXPECT_THROW(GraphPartition(mesh, 0, *world()), InputError);
  EXPECT_THROW(GraphPartition(mesh, 7, *world()), InputError);
  EXPECT_NO_THROW(GraphPartition(mesh, 6, *world()));
}

TEST(PartitionTest, MeshesInPiecesAreNotCut) {
  mesh::MeshArrays arrays;
  arrays.name = "hinge";
  arrays.cellType = mesh::CellType::triangle;
  arrays.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  arrays.cells = {0, 1, 2, 0, 3, 4}; // joined in a node
  arrays.nodeTags = {1, 2, 3, 4, 5};
  arrays.elementTags = {1, 2};
  const mesh::UnstructuredMesh mesh(arrays);
  EXPECT_EQ(GraphPartition(mesh, 1, *world()).numParts(), 1);
  test::expectSays(test::refusal([&] { GraphPartition(mesh, 2, *world()); }),
                   {"only 1 of its 2 elements are joined"});
}

/// The same with quadrilaterals of 8 or hexahedra of 20 nodes.
mesh::MeshArrays withoutInner(mesh::MeshArrays arrays) {
  return completed(std::move(arrays), false, mesh::InnerNodes::none);
}

TEST(PartitionTest, BracedPartsHaveNeighboursAlongAllAxesButOneOfEachElement) {
  for (const auto& counts : {std::array{12, 9, 0}, {6, 5, 4}, {9, 8, 1}}) {
    const mesh::StructuredMesh grid({{0, 0, 0}, {1, 1, 1}}, counts);
    const mesh::UnstructuredMesh mesh(withoutInner(epafi::test::arraysOf(grid, {}, false)));
    const auto expectBraced = [&](const Partition& partition) {
      expectSound(partition, mesh);
      for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element)
        EXPECT_TRUE(isBraced(mesh, element, [&](GlobalOrdinal other) {
          return partition.partOf(other) == partition.partOf(element);
        })) << element;
    };
    const auto numElements = static_cast<int>(mesh.numElements());
    for (const int parts : {1, 5, numElements / 5, numElements / 2, numElements})
      expectBraced(GraphPartition(mesh, parts, *world(), meshing::Parts::braced));
  }
}

/// Nothing can be done for a row of hexahedra.
TEST(PartitionTest, ElementsThatTheBodyDoesNotBraceStayWhereTheyAre) {
  const mesh::UnstructuredMesh mesh(withoutInner(epafi::test::arraysOf(boxMesh(7, 1, 1), {}, false)));
  EXPECT_EQ(GraphPartition(mesh, 3, *world(), meshing::Parts::braced).numParts(), 1);
}

/// Of a column of single prisms neither; two side by side hold each other.
TEST(PartitionTest, PrismsAreBracedByANeighbourAtASide) {
  mesh::MeshArrays arrays = epafi::test::arraysOf(boxMesh(1, 1, 6), {}, epafi::test::Cut::prisms);
  const mesh::UnstructuredMesh pairs(arrays);
  EXPECT_GE(GraphPartition(pairs, 4, *world(), meshing::Parts::braced).numParts(), 2);
  for (GlobalOrdinal element = 0; element < pairs.numElements(); ++element) {
    EXPECT_TRUE(isBraced(pairs, element, [](GlobalOrdinal) { return true; }));
    EXPECT_FALSE(isBraced(pairs, element, [&](GlobalOrdinal other) { return other % 2 == element % 2; }));
  }
}

TEST(PartitionTest, AGroupedGridFallsIntoBlocks) {
  const mesh::StructuredMesh mesh(mesh::rectangle(0, 1, 0, 1), {16, 16, 0}, 1);
  const auto parts = std::make_shared<const GridPartition>(mesh, std::array{8, 8, 1});
  const meshing::GroupedPartition grouped(parts, mesh, 16);
  std::vector<int> elements(64, 0);
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const int part = grouped.partOf(element);
    ++elements[part];
    const GlobalOrdinal i = element % 16, j = element / 16;
    EXPECT_EQ(part / 16, grouped.partOf((j / 8 * 8) * 16 + i / 8 * 8) / 16); // four blocks of 4 × 4 parts
  }
  EXPECT_EQ(elements, std::vector<int>(64, 4));
  for (int part = 0; part < 64; ++part)
    for (const GlobalOrdinal element : grouped.elementsOf(part))
      EXPECT_EQ(grouped.partOf(element), part);
}

TEST(PartitionTest, PartsAreAsManyAsSuitWhereNoneAreAskedFor) {
  for (const int elements : {10, 70, 140}) {
    const scene::Scene scene = oneBody(elements, elements, metis(0), {});
    const int nodes = (elements + 1) * (elements + 1);
    EXPECT_EQ(layoutBodies(scene, *world()).front().partition->numParts(), (nodes + 3999) / 4000);
  }
}

} // namespace
} // namespace epafi::decomposition
