#include "epafi/assembly/FaceWords.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace epafi::assembly {
namespace {

/// Whether a word is a pattern, in which * stands for any letters.
bool matches(const std::string& pattern, const std::string& word, std::size_t p = 0, std::size_t w = 0) {
  if (p == pattern.size())
    return w == word.size();
  if (pattern[p] == '*')
    return matches(pattern, word, p + 1, w) || (w < word.size() && matches(pattern, word, p, w + 1));
  return w < word.size() && pattern[p] == word[w] && matches(pattern, word, p + 1, w + 1);
}

std::vector<std::string> namesOf(const Assembly& assembly) {
  std::vector<std::string> names;
  for (const Solid& solid : assembly.solids)
    names.push_back(solid.name);
  return names;
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
    words.push_back(word);
  return words;
}

/// As --list shows it.
std::string shown(double value, double length) {
  return text(std::abs(value) < 1e-9 * length ? 0 : value, 5);
}

bool isShownAs(double value, double given, double length) {
  return std::abs(value - given) <= 1e-4 * std::abs(given) + 1e-6 * length;
}

/// "+z", "-x", of a cylinder "z"; empty if it is along no axis.
std::string directionOf(const Face& face) {
  constexpr double along = 1 - 1e-6;
  for (std::size_t d = 0; d < 3; ++d)
    if (std::abs(face.axis[d]) > along)
      return (face.kind != "plane" ? "" : face.axis[d] > 0 ? "+" : "-") + std::string(1, "xyz"[d]);
  return "";
}

/// What must hold of a face, beside its kind.
bool holds(const std::string& word, const Face& face, double length) {
  if (word.size() > 2 && word[1] == '=') {
    const double value = parsedReal(word.substr(2));
    const std::size_t axis = std::string("xyz").find(word[0]);
    if (word[0] == 'r')
      return face.radius > 0 && isShownAs(face.radius, value, length);
    if (axis != std::string::npos)
      return isShownAs(face.centre[axis], value, length);
  }
  return word == directionOf(face);
}

const std::vector<std::string> kinds{"plane", "cylinder", "cone", "sphere", "torus", "surface", "face"};

bool isNamed(const std::vector<std::string>& words, const Face& face, double length) {
  if (words.size() == 2 && words[0] == "face" && words[1] == std::to_string(face.number))
    return true;
  return (words[0] == "face" || words[0] == face.kind) &&
         std::all_of(words.begin() + 1, words.end(),
                     [&](const std::string& word) { return holds(word, face, length); });
}

/// "(0, 0, 15)"
std::string placeOf(const Assembly& assembly, const Face& face) {
  std::string words;
  for (const double coordinate : face.centre)
    words += (words.empty() ? "(" : ", ") + shown(coordinate, assembly.diagonal());
  return words + ')';
}

[[noreturn]] void refuseWords(const Assembly& assembly, const std::string& words, int solid) {
  constexpr std::size_t most = 40;
  std::vector<std::string> known;
  for (int f = 0; f < std::ssize(assembly.faces) && known.size() < most; ++f)
    if (const Face& face = assembly.faces[f]; solid < 0 || face.solid == solid)
      known.push_back(wordsOf(assembly, f) + " (face " + std::to_string(face.number) + ", area " +
                      shown(face.area, 0) + ", centre " + placeOf(assembly, face) + ')');
  throw InputError("there is no face " + inQuotes(words) + "; there are " + listed(known) +
                   (known.size() < most ? "" : ", and more that --list shows"));
}

} // namespace

std::vector<int> solidsOf(const Assembly& assembly, const std::string& pattern) {
  std::vector<int> exact, prefixed;
  for (int s = 0; s < std::ssize(assembly.solids); ++s) {
    if (matches(pattern, assembly.solids[s].name))
      exact.push_back(s);
    if (assembly.solids[s].name.starts_with(pattern))
      prefixed.push_back(s);
  }
  if (!exact.empty())
    return exact;
  if (prefixed.size() == 1)
    return prefixed;
  const std::vector<std::string> names = namesOf(assembly);
  const std::string near = nearestName(pattern, names);
  throw InputError((prefixed.empty() ? "there is no body " : "several bodies begin with ") +
                   inQuotes(pattern) + "; there are " + listed(names, "\"") +
                   (prefixed.empty() ? near.empty() ? "" : "; did you mean " + inQuotes(near) + '?'
                                     : ", and \"" + pattern + "*\" means all of these"));
}

std::vector<int> facesOf(const Assembly& assembly, const std::string& words, int solid) {
  const std::size_t slash = words.rfind('/');
  if (slash == std::string::npos && solid < 0)
    throw InputError("the face " + inQuotes(words) + " lacks its body: \"body/" + words + '"');
  const std::vector<int> solids =
      slash == std::string::npos ? std::vector{solid} : solidsOf(assembly, words.substr(0, slash));
  const std::vector<std::string> parts = split(words.substr(slash + 1)); // npos + 1 is 0
  std::vector<int> faces;
  if (!parts.empty() && std::find(kinds.begin(), kinds.end(), parts[0]) != kinds.end())
    for (int f = 0; f < std::ssize(assembly.faces); ++f)
      if (const Face& face = assembly.faces[f];
          std::find(solids.begin(), solids.end(), face.solid) != solids.end() &&
          (solid < 0 || face.solid == solid) && isNamed(parts, face, assembly.diagonal()))
        faces.push_back(f);
  if (faces.empty())
    refuseWords(assembly, words, solids.front());
  return faces;
}

int cornerOf(const Assembly& assembly, const std::string& words) {
  const std::size_t slash = words.rfind('/');
  const std::vector<std::string> parts = split(words.substr(slash + 1));
  if (slash == std::string::npos || parts.size() != 4 || parts[0] != "point")
    return -1;
  const int solid = solidsOf(assembly, words.substr(0, slash)).front();
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < std::ssize(assembly.corners); ++c) {
    const Corner& corner = assembly.corners[c];
    const double distance =
        std::hypot(corner.place[0] - parsedReal(parts[1]), corner.place[1] - parsedReal(parts[2]),
                   corner.place[2] - parsedReal(parts[3]));
    if (corner.solid == solid && distance < least) {
      least = distance;
      nearest = c;
    }
  }
  if (least > 1e-3 * assembly.diagonal())
    throw InputError("there is no corner " + inQuotes(words) +
                     (nearest < 0 ? "" : "; the nearest is " + text(assembly.corners[nearest].place)));
  return nearest;
}

std::string wordsOf(const Assembly& assembly, int face) {
  const Face& own = assembly.faces[face];
  const double length = assembly.diagonal();
  const auto isUnique = [&](const std::string& words) {
    return facesOf(assembly, words, own.solid).size() == 1;
  };
  std::string words = own.kind;
  std::vector<std::string> more;
  if (own.radius > 0)
    more.push_back("r=" + shown(own.radius, length));
  if (const std::string direction = directionOf(own); !direction.empty())
    more.push_back(direction);
  for (std::size_t d = 0; d < 3; ++d)
    more.push_back(std::string(1, "xyz"[d]) + '=' + shown(own.centre[d], length));
  const std::size_t always = more.size() - 3; // a size and a direction say what one sees
  for (std::size_t i = 0; i < always; ++i)
    words += ' ' + more[i];
  if (isUnique(words))
    return words;
  for (std::size_t i = always; i < more.size(); ++i)
    if (isUnique(words + ' ' + more[i]))
      return words + ' ' + more[i];
  return "face " + std::to_string(own.number);
}

std::string tableOf(const Assembly& assembly) {
  std::ostringstream table;
  for (int f = 0; f < std::ssize(assembly.faces); ++f) {
    const Face& face = assembly.faces[f];
    const std::string words =
        assembly.solids[face.solid].name + '/' + (assembly.unit.empty() ? face.group : wordsOf(assembly, f));
    table << "  " << std::left << std::setw(44) << words << " face " << std::setw(5) << face.number << ' '
          << "area " << std::setw(9) << shown(face.area, 0) << " centre " << placeOf(assembly, face) << '\n';
  }
  return table.str();
}

} // namespace epafi::assembly
