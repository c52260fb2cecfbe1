#pragma once

#include "epafi/mesh/Box.hpp"
#include "epafi/mesh/MeshOrder.hpp"

#include <array>
#include <compare>
#include <string>
#include <vector>

namespace epafi::meshing {

/// How small the elements of a STEP file are, where its solids are not thin.
struct StepSizes {
  int elementsAround = 16; ///< a circle
  /// x, y and z of points, and the size of elements there: it grows by half the distance
  std::vector<double> finePoints{};

  auto operator<=>(const StepSizes&) const = default;
};

/// Where the elements come from: a structured box, or a file.
struct MeshSource {
  mesh::Box box;                        ///< of a structured mesh
  std::array<int, 3> elements{0, 0, 0}; ///< in x, y and z (z: 0 in the plane); of a structured mesh
  std::string file;                     ///< if not empty, a file that Gmsh reads, or several
  double sizeFactor = 1;                ///< by which all element sizes of a geometry are multiplied
  StepSizes stepSizes;                  ///< of a STEP file
  int refinements = 0;                  ///< how often every element of the file is split
  int order = 1;                        ///< of the elements, 1 or 2; 0: as the mesh file has it
  mesh::InnerNodes innerNodes = mesh::InnerNodes::added; ///< of elements of order 2 from a file
  std::string group; ///< the physical group in it that is this body; empty: all its elements
  /// Words for surfaces that the body is to have beside those of the file (mesh/SmoothPieces.hpp).
  std::vector<std::string> pieces{};
};

/// Whether the name of a mesh file stands for several, which hold a mesh by parts: "press_*.msh".
bool isSplit(const std::string& file);

/// Whether a file describes an assembly of solids, by its name: .step or .stp, in small or capital letters.
bool isStep(const std::string& file);

/// Whether Gmsh meshes the file: .geo, or isStep().
bool isGeometry(const std::string& file);

} // namespace epafi::meshing
