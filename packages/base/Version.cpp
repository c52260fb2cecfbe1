#include "epafi/base/Version.hpp"

namespace epafi {

const char* version() {
  return EPAFI_VERSION;
}

} // namespace epafi
