#pragma once

#include "epafi/mesh/Cell.hpp"

#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace epafi::test {

/// Lines of a rectangular grid in x, y and z; z empty in the plane.
using GridLines = std::array<std::vector<double>, 3>;

/// Corners of the cells that a square or cube of the grid is cut into, by their bits x, y, z.
inline std::vector<std::vector<int>> cellsOfCube(mesh::CellType type) {
  switch (type) {
  case mesh::CellType::triangle:
    return {{0, 1, 3}, {0, 3, 2}};
  case mesh::CellType::quadrilateral:
    return {{0, 1, 3, 2}};
  case mesh::CellType::tetrahedron: // around the diagonal 0–7
    return {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  default:
    return {{0, 1, 3, 2, 4, 5, 7, 6}};
  }
}

/// Writes a file of Gmsh, format 2.2: the grid's cells, and as surfaces "left" (x least), "front" (y least,
/// in space), "bottom" and "top" (last coordinate least and greatest).
class GmshBox {
public:
  GmshBox(mesh::CellType type, GridLines lines) : type_(type), lines_(std::move(lines)) {
    for (std::size_t d = 0; d < 3; ++d)
      counts_[d] = lines_[d].empty() ? 1 : static_cast<int>(lines_[d].size());
  }

  [[nodiscard]] std::string text() {
    const int last = mesh::dimensionOf(type_) - 1;
    for (int k = 0; k + 1 < std::max(counts_[2], 2); ++k)
      for (int j = 0; j + 1 < counts_[1]; ++j)
        for (int i = 0; i + 1 < counts_[0]; ++i)
          for (const std::vector<int>& bits : cellsOfCube(type_))
            add(code(), 1, cornersOf({i, j, k}, bits));
    const std::vector<Cell> cells = cells_;
    addSurface(cells, 2, 0, 0);
    if (last == 2)
      addSurface(cells, 3, 1, 0);
    addSurface(cells, 4, last, 0);
    addSurface(cells, 5, last, counts_[last] - 1);
    std::ostringstream file;
    file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
         << (last == 2 ? 5 : 4) << '\n'
         << last + 1 << " 1 \"block\"\n"
         << last << " 2 \"left\"\n";
    if (last == 2)
      file << "2 3 \"front\"\n";
    file << last << " 4 \"bottom\"\n" << last << " 5 \"top\"\n$EndPhysicalNames\n";
    writeNodes(file);
    file << "$Elements\n" << cells_.size() << '\n';
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      file << e + 1 << ' ' << cells_[e].code << " 2 " << cells_[e].group << ' ' << cells_[e].group;
      for (const int node : cells_[e].nodes)
        file << ' ' << node + 1;
      file << '\n';
    }
    file << "$EndElements\n";
    return file.str();
  }

private:
  struct Cell {
    int code, group;
    std::vector<int> nodes;
  };

  [[nodiscard]] int code() const { return std::array{2, 3, 4, 5}.at(static_cast<std::size_t>(type_)); }
  void add(int code, int group, const std::vector<int>& nodes) { cells_.push_back({code, group, nodes}); }

  [[nodiscard]] std::vector<int> cornersOf(const std::array<int, 3>& cube,
                                           const std::vector<int>& bits) const {
    std::vector<int> nodes;
    for (const int bit : bits)
      nodes.push_back((cube[0] + (bit & 1)) +
                      counts_[0] * ((cube[1] + (bit >> 1 & 1)) + counts_[1] * (cube[2] + (bit >> 2 & 1))));
    return nodes;
  }

  [[nodiscard]] int lineOf(int node, int direction) const {
    return std::array{node % counts_[0], node / counts_[0] % counts_[1], node / counts_[0] / counts_[1]}.at(
        static_cast<std::size_t>(direction));
  }

  void addSurface(const std::vector<Cell>& cells, int group, int direction, int line) {
    const int corners = mesh::nodesPerFacet(type_);
    for (const Cell& cell : cells)
      for (const auto& facet : mesh::facetsOf(type_)) {
        std::vector<int> nodes;
        for (int i = 0; i < corners; ++i)
          nodes.push_back(cell.nodes[facet[i]]);
        bool liesThere = true;
        for (const int node : nodes)
          liesThere = liesThere && lineOf(node, direction) == line;
        if (liesThere)
          add(corners - 1, group, nodes);
      }
  }

  void writeNodes(std::ostream& file) const {
    const int number = counts_[0] * counts_[1] * counts_[2];
    file.precision(17);
    file << "$Nodes\n" << number << '\n';
    for (int node = 0; node < number; ++node) {
      file << node + 1;
      for (int d = 0; d < 3; ++d) {
        const std::vector<double>& lines = lines_[d];
        file << ' ' << (lines.empty() ? 0.0 : lines[lineOf(node, d)]);
      }
      file << '\n';
    }
    file << "$EndNodes\n";
  }

  mesh::CellType type_;
  GridLines lines_;
  std::array<int, 3> counts_{};
  std::vector<Cell> cells_;
};

} // namespace epafi::test
