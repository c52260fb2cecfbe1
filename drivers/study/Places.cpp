#include "Places.hpp"

namespace epafi::drivers {

std::filesystem::path programDirectory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::filesystem::path sceneDirectory() {
  return (programDirectory() / EPAFI_SCENES_FROM_PROGRAMS).lexically_normal();
}

} // namespace epafi::drivers
