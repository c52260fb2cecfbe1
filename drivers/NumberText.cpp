#include "NumberText.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace epafi::drivers {

std::string bytes(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  if (value >= 1e9)
    text << value / 1e9 << " GB";
  else
    text << value / 1e6 << " MB";
  return text.str();
}

std::string seconds(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(value < 1 ? 3 : 2) << value << " s";
  return text.str();
}

std::string scientific(double value, int digits) {
  std::ostringstream text;
  text << std::scientific << std::setprecision(digits) << value;
  return text.str();
}

std::string rounded(double value) {
  std::ostringstream text;
  text << std::setprecision(5) << value;
  return text.str();
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::setprecision(2) << 100 * share << " %";
  return text.str();
}

std::string valueWithBar(double value, double bar) {
  std::ostringstream text;
  text << std::setprecision(8) << value << " ± " << std::setprecision(2) << bar;
  if (value != 0)
    text << " (" << percent(bar / std::abs(value)) << ')';
  return text.str();
}

std::string counted(GlobalOrdinal number, const std::string& noun) {
  return std::to_string(number) + ' ' + noun + (number == 1 ? "" : "s");
}

} // namespace epafi::drivers
