#include "epafi/output/FrdRecords.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Version.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace epafi::output {
namespace {

/// Places of an element's nodes in the order of the format: on the edges of hexahedra and prisms below,
/// upright and above. It has no pyramids, which are hexahedra there whose top has shrunk to a node.
constexpr std::array inOrder{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
constexpr std::array inHexahedron{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
constexpr std::array inPrism{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11};
constexpr std::array inPyramid{0, 1, 2, 3, 4, 4, 4, 4, 5, 6, 7, 8, 9, 10, 11, 12, 4, 4, 4, 4};

/// The format's number of a type of elements, and its nodes.
struct FrdCell {
  int type;
  std::span<const int> places;
};

FrdCell frdCellOf(mesh::CellType type) {
  using enum mesh::CellType;
  const auto first = [](std::size_t number) { return std::span(inOrder).first(number); };
  switch (type) {
  case triangle:
    return {7, first(3)};
  case quadrilateral:
    return {9, first(4)};
  case tetrahedron:
    return {3, first(4)};
  case pyramid:
    return {1, std::span(inPyramid).first(8)};
  case prism:
    return {2, first(6)};
  case hexahedron:
    return {1, first(8)};
  case triangle6:
    return {8, first(6)};
  case quadrilateral8:
  case quadrilateral9:
    return {10, first(8)};
  case tetrahedron10:
    return {6, first(10)};
  case pyramid13:
    return {4, inPyramid};
  case prism15:
    return {5, inPrism};
  case hexahedron20:
  case hexahedron27:
    return {4, inHexahedron};
  case line:
  case line3:
    break;
  }
  throw Error(std::string("No body consists of a ") + mesh::toString(type) + ".");
}

void put(std::string& text, GlobalOrdinal number, std::size_t width) {
  const std::string digits = std::to_string(number);
  text.append(width - std::min(width, digits.size()), ' ').append(digits);
}

/// As C's %12.5E.
void put(std::string& text, double value) {
  constexpr double least = std::numeric_limits<float>::min(), most = std::numeric_limits<float>::max();
  const double shown = std::abs(value) < least ? 0 : std::clamp(value, -most, most);
  std::array<char, 16> digits{};
  char* const end = std::to_chars(digits.begin(), digits.end(), shown, std::chars_format::scientific, 5).ptr;
  std::replace(digits.begin(), end, 'e', 'E');
  text.append(12 - (end - digits.begin()), ' ').append(digits.begin(), end);
}

} // namespace

const char* const frdDisplacement = " -4  DISP        4    1\n"
                                    " -5  D1          1    2    1    0\n"
                                    " -5  D2          1    2    2    0\n"
                                    " -5  D3          1    2    3    0\n"
                                    " -5  ALL         1    2    0    0    1ALL\n";
const char* const frdStress = " -4  STRESS      6    1\n"
                              " -5  SXX         1    4    1    1\n"
                              " -5  SYY         1    4    2    2\n"
                              " -5  SZZ         1    4    3    3\n"
                              " -5  SXY         1    4    1    2\n"
                              " -5  SYZ         1    4    2    3\n"
                              " -5  SZX         1    4    3    1\n";
const char* const frdStrain = " -4  TOSTRAIN    6    1\n"
                              " -5  EXX         1    4    1    1\n"
                              " -5  EYY         1    4    2    2\n"
                              " -5  EZZ         1    4    3    3\n"
                              " -5  EXY         1    4    1    2\n"
                              " -5  EYZ         1    4    2    3\n"
                              " -5  EZX         1    4    3    1\n";
const char* const frdForce = " -4  FORC        4    1\n"
                             " -5  F1          1    2    1    0\n"
                             " -5  F2          1    2    2    0\n"
                             " -5  F3          1    2    3    0\n"
                             " -5  ALL         1    2    0    0    1ALL\n";
const char* const frdContact = " -4  CONTACT     6    1\n"
                               " -5  COPEN       1    4    1    1\n"
                               " -5  CSLIP1      1    4    2    2\n"
                               " -5  CSLIP2      1    4    3    3\n"
                               " -5  CPRESS      1    4    1    2\n"
                               " -5  CSHEAR1     1    4    2    3\n"
                               " -5  CSHEAR2     1    4    3    1\n";

void putFrdStart(std::string& text, std::span<const std::string> bodies) {
  text.append("    1C\n    1UPGM               Epafi\n    1UVERSION           Version ");
  text.append(epafi::version()).append("\n");
  int material = 0;
  for (const std::string& body : bodies) {
    text += "    1UMAT";
    put(text, ++material, 5);
    text += body + '\n';
  }
}

void putFrdSize(std::string& text, const char* key, GlobalOrdinal number) {
  text.append(key).append(18, ' ');
  put(text, number, 12);
  text.append(37, ' ').append("1\n");
}

void putFrdNode(std::string& text, GlobalOrdinal number, std::span<const double> values) {
  text += " -1";
  put(text, number, 10);
  for (const double value : values)
    put(text, value);
  text += '\n';
}

void putFrdElement(std::string& text, GlobalOrdinal number, int material, mesh::CellType type,
                   std::span<const GlobalOrdinal> nodes) {
  constexpr std::size_t perLine = 10;
  const FrdCell cell = frdCellOf(type);
  text += " -1";
  put(text, number, 10);
  for (const int value : {cell.type, 0, material})
    put(text, value, 5);
  for (std::size_t i = 0; i < cell.places.size(); ++i) {
    if (i % perLine == 0)
      text += "\n -2";
    put(text, nodes[cell.places[i]], 10);
  }
  text += '\n';
}

void putFrdEnd(std::string& text) {
  text += " -3\n";
}

void putFrdHead(std::string& text, const FrdPlace& place, GlobalOrdinal numNodes, const char* kind) {
  text.append("    1PSTEP").append(14, ' ');
  for (const int number : {place.block, 1, place.step})
    put(text, number, 12);
  text.append(10, ' ').append("\n");
  if (!place.name.empty()) // the next record has room for it, but several programs count the words there
    text += "    1PNAME              " + place.name + '\n';
  text += "  100CL";
  put(text, 100 + place.increment, 5);
  put(text, place.step);
  put(text, numNodes, 12);
  text.append(20, ' ').append(" 0");
  put(text, place.increment, 5);
  text.append(10, ' ').append(" 1\n").append(kind);
}

} // namespace epafi::output
