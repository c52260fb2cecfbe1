#include "epafi/meshing/MeshSource.hpp"

namespace epafi::meshing {

bool isSplit(const std::string& file) {
  return file.find('*', file.rfind('/') + 1) != std::string::npos; // npos + 1 is 0
}

} // namespace epafi::meshing
