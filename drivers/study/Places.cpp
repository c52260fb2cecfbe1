#include "Places.hpp"

namespace epafi::drivers {

std::filesystem::path programDirectory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::filesystem::path sceneDirectory() {
  return EPAFI_SCENES;
}

} // namespace epafi::drivers
