#include "epafi/meshing/MeshSource.hpp"

#include <algorithm>

namespace epafi::meshing {
namespace {

const std::array<std::string, 4> endings{".step", ".stp", ".STEP", ".STP"};

} // namespace

bool isSplit(const std::string& file) {
  return file.find('*', file.rfind('/') + 1) != std::string::npos; // npos + 1 is 0
}

bool isStep(const std::string& file) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& ending) { return file.ends_with(ending); });
}

bool isGeometry(const std::string& file) {
  return file.ends_with(".geo") || isStep(file);
}

} // namespace epafi::meshing
