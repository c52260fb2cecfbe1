#pragma once

/// Numbers as the screen has them.

#include "epafi/base/Types.hpp"

#include <string>

namespace epafi::drivers {

std::string bytes(double value);                                    ///< "1.2 GB", "3.4 MB"
std::string seconds(double value);                                  ///< "0.123 s", "12.30 s"
std::string scientific(double value, int digits);                   ///< digits after the point
std::string rounded(double value);                                  ///< 5 digits
std::string percent(double share);                                  ///< "1.2 %", "0.00034 %"
std::string valueWithBar(double value, double bar);                 ///< "1.2345 ± 0.0012 (0.1 %)"
std::string counted(GlobalOrdinal number, const std::string& noun); ///< "1 rank", "2 ranks"

} // namespace epafi::drivers
