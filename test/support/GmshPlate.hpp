#pragma once

#include "support/MeshFiles.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/meshing/GmshFile.hpp"

#include <gtest/gtest.h>

#include <string>

namespace epafi::test {

/// 4---5---6
/// | 2 | 3 |   and the edge 1–4, element 1, is the surface "left"; the right square is the group "right"
/// 1---2---3
inline const std::string plate22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "left"
2 2 "west"
2 3 "right"
$EndPhysicalNames
$Nodes
7
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
9 5 5 0
$EndNodes
$Elements
4
1 1 2 1 1 1 4
2 3 2 2 1 1 2 5 4
3 3 2 3 2 2 3 6 5
4 15 2 0 3 9
$EndElements
)";

inline const std::string head41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "left"
2 2 "west"
2 3 "right"
$EndPhysicalNames
$Entities
1 1 2 0
3 5 5 0 0
1 0 0 0 0 1 0 1 1 0
1 0 0 0 1 1 0 1 2 0
2 1 0 0 2 1 0 1 3 0
$EndEntities
)";

inline const std::string nodes41 = R"($Nodes
4 7 1 9
0 3 0 1
9
5 5 0
1 1 0 2
1
4
0 0 0
0 1 0
2 1 0 2
2
5
1 0 0
1 1 0
2 2 0 2
3
6
2 0 0
2 1 0
$EndNodes
)";

inline const std::string elements41 = R"($Elements
3 3 1 3
1 1 1 1
1 1 4
2 1 3 1
2 1 2 5 4
2 2 3 1
3 2 3 6 5
$EndElements
)";

inline const std::string plate41 = head41 + nodes41 + elements41;

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

inline double measureOf(const mesh::Mesh& mesh, GlobalOrdinal element) {
  std::vector<Point> points;
  mesh.elementPoints(element, points);
  return shapeOf(mesh::ElementNodes(mesh, element).type(), points).measure;
}

inline double measureOf(const mesh::Mesh& mesh) {
  double sum = 0;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element)
    sum += measureOf(mesh, element);
  return sum;
}

/// Files of Gmsh in a folder of their own.
class GmshTest : public testing::Test {
protected:
  [[nodiscard]] meshing::GmshFile plate(const std::string& text) const {
    return meshing::GmshFile(folder.write("plate.msh", text));
  }
  void expectRefused(const std::string& text, const std::vector<std::string>& parts,
                     const std::string& group = "", const std::string& name = "plate.msh") const {
    const std::string file = folder.write(name, text);
    expectRefusal([&] { (void)meshing::GmshFile(file).body(group); }, parts);
  }

  MeshFolder folder;
};

} // namespace epafi::test
