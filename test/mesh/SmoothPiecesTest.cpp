#include "epafi/mesh/SmoothPieces.hpp"

#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace epafi::mesh {
namespace {

/// A ring of `around` quadrilaterals between radii 1 and 2.
UnstructuredMesh ring(int around) {
  MeshArrays mesh;
  mesh.name = "The ring";
  mesh.cellType = CellType::quadrilateral;
  for (int i = 0; i < around; ++i)
    for (int j = 1; j <= 2; ++j) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.points.push_back({j * std::cos(angle), j * std::sin(angle), 0});
      mesh.nodeTags.push_back(2 * i + j);
    }
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    mesh.cells.insert(mesh.cells.end(), {2 * i, 2 * i + 1, 2 * next + 1, 2 * next});
    mesh.elementTags.push_back(i + 1);
  }
  return UnstructuredMesh(std::move(mesh));
}

std::vector<std::vector<std::size_t>> piecesOf(const UnstructuredMesh& mesh) {
  return smoothPieces(mesh.boundary(), [&](GlobalOrdinal node) { return mesh.point(node); });
}

TEST(SmoothPiecesTest, GoOnRoundAnglesUpToFortyDegrees) {
  const auto round = piecesOf(ring(10)), hexagons = piecesOf(ring(6));
  ASSERT_EQ(round.size(), 2);
  EXPECT_EQ(round[0].size(), 10);
  EXPECT_EQ(round[1].size(), 10);
  EXPECT_EQ(hexagons.size(), 12);
}

TEST(SmoothPiecesTest, AreNamedByTheNearestPlace) {
  UnstructuredMesh mesh = ring(12);
  mesh.namePiece("at 0.9 0.1");
  mesh.namePiece("at -2.5 1");
  mesh.namePiece("at -2.5 1"); // once is enough
  ASSERT_EQ(mesh.surfaceNames(), (std::vector<std::string>{"at 0.9 0.1", "at -2.5 1"}));
  for (const auto& [name, radius] : {std::pair("at 0.9 0.1", 1.0), {"at -2.5 1", 2.0}}) {
    const Surface surface = mesh.surface(name);
    EXPECT_EQ(surface.numFacets(), 12);
    for (const GlobalOrdinal node : surface.facetNodes)
      EXPECT_NEAR(std::hypot(mesh.point(node)[0], mesh.point(node)[1]), radius, 1e-12);
  }
}

TEST(SmoothPiecesTest, NearestIsTheFacetItselfAndNotItsPlane) {
  MeshArrays arrays;
  arrays.name = "The tetrahedron";
  arrays.cellType = CellType::tetrahedron;
  arrays.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  arrays.cells = {0, 1, 2, 3};
  arrays.nodeTags = {1, 2, 3, 4};
  arrays.elementTags = {1};
  UnstructuredMesh mesh(std::move(arrays));
  for (const auto& [words, axis] :
       {std::pair("at 0.3 0.3 -0.1", 2), {"at 3 -0.1 -0.2", -1}, {"at -1 .2 .3", 0}}) {
    mesh.namePiece(words);
    const Surface surface = mesh.surface(words);
    ASSERT_EQ(surface.numFacets(), 1) << words;
    if (axis < 0)
      continue; // a corner, of which three facets are as near
    for (const GlobalOrdinal node : surface.facetNodes)
      EXPECT_EQ(mesh.point(node)[static_cast<std::size_t>(axis)], 0) << words;
  }
}

TEST(SmoothPiecesTest, PlacesInWordsAreThoseAlone) {
  EXPECT_EQ(wordsOfPlace({10, -0.25, 3e-7}, 3), "at 10 -0.25 3e-07");
  EXPECT_EQ(wordsOfPlace({10, -0.25, 0}, 2), "at 10 -0.25");
  EXPECT_EQ(placeIn("at 10 -0.25 3e-07"), (Point{10, -0.25, 3e-7}));
  EXPECT_EQ(placeIn("at 1 2"), (Point{1, 2, 0}));
  for (const char* const other : {"", "at", "at 1", "at 1 2 3 4", "at the top", "top", "at1 2"})
    EXPECT_FALSE(placeIn(other)) << other;
}

} // namespace
} // namespace epafi::mesh
