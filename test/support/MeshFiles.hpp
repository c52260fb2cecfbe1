#pragma once

#include "support/Refusal.hpp"
#include "support/SampleCells.hpp"

#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace epafi::test {

/// A folder for mesh files that goes with the object.
class MeshFolder {
public:
  MeshFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("epafi-mesh-" + std::to_string(::getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~MeshFolder() { std::filesystem::remove_all(path_); }
  MeshFolder(const MeshFolder&) = delete;
  MeshFolder& operator=(const MeshFolder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path(name);
  }

private:
  std::filesystem::path path_;
};

/// Expects that `work` throws an InputError whose text holds every one of `parts`.
template <class Work>
void expectRefusal(const Work& work, const std::vector<std::string>& parts) {
  const std::string said = refusal(work);
  for (const std::string& part : parts)
    EXPECT_NE(said.find(part), std::string::npos) << '"' << part << "\" is not in: " << said;
}

/// Area vectors (in the plane: normal times length) of a surface's facets, outward if the facets are ordered
/// so.
inline std::vector<Eigen::Vector3d> areaVectors(const mesh::Mesh& mesh, const mesh::Surface& surface) {
  std::vector<Eigen::Vector3d> vectors;
  for (std::size_t f = 0; f < surface.elements.size(); ++f) {
    std::vector<Eigen::Vector3d> x;
    for (const GlobalOrdinal node : surface.facet(f))
      x.push_back(vectorOf(mesh.point(node)));
    if (x.size() == 2)
      vectors.emplace_back(x[1][1] - x[0][1], x[0][0] - x[1][0], 0.0);
    else if (x.size() == 3)
      vectors.emplace_back((x[1] - x[0]).cross(x[2] - x[0]) / 2);
    else
      vectors.emplace_back((x[2] - x[0]).cross(x[3] - x[1]) / 2);
  }
  return vectors;
}

} // namespace epafi::test
