#include "epafi/output/SafeNames.hpp"

#include <algorithm>
#include <set>

namespace epafi::output {
namespace {

bool isSafe(char letter) {
  const auto code = static_cast<unsigned char>(letter);
  return (code >= '0' && code <= '9') || (code >= 'A' && code <= 'Z') || (code >= 'a' && code <= 'z') ||
         letter == '_' || letter == '-' || letter == '.' || code >= 0x80;
}

} // namespace

std::vector<std::string> safeNames(const std::vector<std::string>& names) {
  std::vector<std::string> result;
  std::set<std::string> taken;
  for (std::string name : names) {
    std::replace_if(
        name.begin(), name.end(), [](char letter) { return !isSafe(letter); }, '_');
    if (name.find_first_not_of('.') == std::string::npos)
      name = "unnamed";
    std::string candidate = name;
    for (int number = 2; !taken.insert(candidate).second; ++number)
      candidate = name + "_" + std::to_string(number);
    result.push_back(candidate);
  }
  return result;
}

} // namespace epafi::output
