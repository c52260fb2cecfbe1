#include "epafi/assembly/AssemblyPairs.hpp"

#include "epafi/assembly/FaceWords.hpp"
#include "epafi/assembly/PairSearch.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <utility>

namespace epafi::assembly {
namespace {

using Teuchos::ParameterList;

const std::string& nameOf(const Assembly& assembly, int face) {
  return assembly.solids[assembly.faces[face].solid].name;
}

/// Gap or overlap everywhere the same.
bool isConforming(const FacePair& pair) {
  return pair.largestGap - pair.leastGap <=
         0.1 * std::max(std::abs(pair.largestGap), std::abs(pair.leastGap));
}

/// Both of a pair, the lower first.
std::pair<int, int> key(int a, int b) {
  return std::minmax(a, b);
}

/// The one face that a hand-made pair names.
int faceOf(const Assembly& assembly, const ParameterList& pair, const std::string& side, int solid) {
  const auto words =
      pair.isType<std::string>(side + " Surface") ? pair.get<std::string>(side + " Surface") : "";
  const std::vector<int> faces = facesOf(assembly, words, solid);
  if (faces.size() == 1)
    return faces.front();
  std::vector<std::string> names;
  for (const int face : faces)
    names.push_back(wordsOf(assembly, face));
  throw InputError(inQuotes(words) + " is several faces of " + inQuotes(assembly.solids[solid].name) + ", " +
                   listed(names, "\"") + ", but a side of a pair is one");
}

/// Bodies and surfaces in words become those of the mesh. Returns the faces, −1 for an obstacle.
std::pair<int, int> resolve(const Assembly& assembly, ParameterList& pair) {
  int faces[] = {-1, -1};
  const char* const sides[] = {"First", "Second"};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string side = sides[i], body = side + " Body";
    if (!pair.isType<std::string>(body))
      continue;
    const std::vector<int> solids = solidsOf(assembly, pair.get<std::string>(body));
    if (solids.size() > 1)
      throw InputError(inQuotes(pair.get<std::string>(body)) +
                       " is several bodies, but a side of a pair is one");
    faces[i] = faceOf(assembly, pair, side, solids.front());
    pair.set(body, nameOf(assembly, faces[i]));
    pair.set(side + " Surface", assembly.faces[faces[i]].group);
  }
  return key(faces[0], faces[1]);
}

/// Faces of a body, or those that words name.
std::set<int> facesIn(const Assembly& assembly, const std::string& words) {
  std::set<int> faces;
  for (int f = 0; f < std::ssize(assembly.faces); ++f)
    if (words == nameOf(assembly, f) + '/' + assembly.faces[f].group)
      return {f};
  if (words.find('/') != std::string::npos) {
    for (const int face : facesOf(assembly, words))
      faces.insert(face);
    return faces;
  }
  const std::vector<int> solids = solidsOf(assembly, words);
  for (int f = 0; f < std::ssize(assembly.faces); ++f)
    if (std::find(solids.begin(), solids.end(), assembly.faces[f].solid) != solids.end())
      faces.insert(f);
  return faces;
}

/// Takes out the pairs that an item of Exclude means.
void exclude(const Assembly& assembly, const std::string& item, std::vector<FacePair>& pairs) {
  const std::size_t dash = item.find(" - ");
  const std::set<int> a = facesIn(assembly, trimmed(item.substr(0, dash)));
  const std::set<int> b =
      dash == std::string::npos ? std::set<int>() : facesIn(assembly, trimmed(item.substr(dash + 3)));
  std::erase_if(pairs, [&](const FacePair& pair) {
    if (dash == std::string::npos)
      return a.contains(pair.first) || a.contains(pair.second);
    return (a.contains(pair.first) && b.contains(pair.second)) ||
           (a.contains(pair.second) && b.contains(pair.first));
  });
}

/// "bolt M12" of "bolt M12:3".
std::string partOf(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  return colon != std::string::npos && name.find_first_not_of("0123456789", colon + 1) == std::string::npos
             ? name.substr(0, colon)
             : name;
}

/// Facets must not be off by so much that one cannot tell whether surfaces are near.
void refuseCoarse(const Assembly& assembly, const std::vector<FacePair>& pairs, double distance) {
  for (const FacePair& pair : pairs)
    if (pair.sag > smallSag * distance) {
      const Face &first = assembly.faces[pair.first], &second = assembly.faces[pair.second];
      throw InputError(
          "whether " + inQuotes(first.group) + " of " + inQuotes(nameOf(assembly, pair.first)) + " and " +
          inQuotes(second.group) + " of " + inQuotes(nameOf(assembly, pair.second)) +
          " touch cannot be told: near " + text(pair.closest, 4) +
          " their facets are off the round surfaces by " + text(pair.sag, 2) +
          ", which is not small beside the Distance of " + text(distance, 3) +
          " up to which pairs are found; mesh them finer or in order 2, give a greater Distance, "
          "name the pair by hand, or leave it out by Exclude");
    }
}

std::string gapsOf(const FacePair& pair, double length) {
  const auto rounded = [&](double gap) { return text(std::abs(gap) < 1e-7 * length ? 0 : std::abs(gap), 3); };
  const std::string least = rounded(pair.leastGap), largest = rounded(pair.largestGap);
  const double size = std::max(std::abs(pair.leastGap), std::abs(pair.largestGap));
  const std::string sag =
      pair.sag > std::max(0.05 * size, 1e-7 * length) ? ", facets off by up to " + text(pair.sag, 2) : "";
  if (pair.leastGap < -1e-7 * length)
    return "overlap " + least + sag;
  return (least == largest ? "gap " + least : "gap " + least + " to " + largest) + sag;
}

} // namespace

bool isPoint(const Assembly& assembly, const FacePair& pair) {
  return !isConforming(pair) && pair.area < 0.9 * assembly.faces[pair.first].area;
}

bool isThread(const Assembly& assembly, const FacePair& pair) {
  const Face &a = assembly.faces[pair.first], &b = assembly.faces[pair.second];
  const double same = 1e-6 * assembly.diagonal();
  return a.kind == "cylinder" && b.kind == "cylinder" && std::abs(a.radius - b.radius) < same &&
         std::abs(pair.leastGap) < same && std::abs(pair.largestGap) < same && pair.area > 0.9 * a.area;
}

int elementsAroundFor(const Assembly& assembly) {
  constexpr double share = 0.01; // of the gap, R (1 − cos(π/n))²/8 being what quadratic facets are off by
  int number = 16;
  for (const FacePair& pair : assembly.pairs) {
    const double radius = assembly.faces[pair.first].radius;
    const double gap = std::min(std::abs(pair.leastGap), std::abs(pair.largestGap));
    if (radius > 0 && isConforming(pair) && gap > 1e-6 * radius)
      number = std::max(number, static_cast<int>(std::ceil(
                                    std::numbers::pi / std::acos(1 - std::sqrt(8 * share * gap / radius)))));
  }
  constexpr int most = 96; // beyond that it would take too long unasked
  return std::min(number, most);
}

ParameterList contactsOf(const Assembly& assembly, const ParameterList& given, const ParameterList& automatic,
                         std::string& notes) {
  ParameterList contacts("Contact");
  FacesInPairs known;
  for (const auto& entry : given) {
    if (!entry.second.isList())
      throw InputError("list \"Contact\" holds the parameter " + inQuotes(entry.first) +
                       ", but must hold lists, one a pair");
    ParameterList& pair = contacts.sublist(entry.first);
    pair.setParameters(Teuchos::getValue<ParameterList>(entry.second));
    known.insert(resolve(assembly, pair));
  }
  addFoundPairs(assembly, automatic, known, contacts, notes);
  return contacts;
}

void addFoundPairs(const Assembly& assembly, const ParameterList& automatic, const FacesInPairs& known,
                   ParameterList& contacts, std::string& notes) {
  std::vector<FacePair> pairs = assembly.pairs;
  std::erase_if(pairs, [&](const FacePair& pair) { return known.contains(key(pair.first, pair.second)); });
  std::istringstream excluded(automatic.get<std::string>("Exclude"));
  for (std::string item; std::getline(excluded, item, ',');)
    exclude(assembly, trimmed(item), pairs);
  const auto searchDistance = PairSearch{automatic.get<double>("Distance")}.distanceIn(assembly);
  refuseCoarse(assembly, pairs, searchDistance);
  for (const FacePair& pair : pairs) {
    const Face &first = assembly.faces[pair.first], &second = assembly.faces[pair.second];
    std::string name = nameOf(assembly, pair.first) + " - " + nameOf(assembly, pair.second);
    if (contacts.isSublist(name))
      name += ", face " + std::to_string(first.number) + " - " + std::to_string(second.number);
    ParameterList& contact = contacts.sublist(name);
    const auto kind = automatic.get<std::string>(isThread(assembly, pair) ? "Threads" : "Kind");
    contact.set("Kind", kind)
        .set("First Body", nameOf(assembly, pair.first))
        .set("First Surface", first.group)
        .set("Second Body", nameOf(assembly, pair.second))
        .set("Second Surface", second.group);
    if (const double friction = automatic.get<double>("Friction"); friction > 0 && kind == "contact")
      contact.set("Friction", friction);
    if (isPoint(assembly, pair)) // what is far apart stays so
      contact.set("Distance", nearMissFactor * searchDistance);
  }
  notes += wordsOfPairs(assembly, pairs) + wordsOfNearMisses(assembly);
  const auto numThreads = std::count_if(pairs.begin(), pairs.end(),
                                        [&](const FacePair& pair) { return isThread(assembly, pair); });
  if (numThreads > 0)
    notes += std::to_string(numThreads) + " of these, cylinders that coincide, are " +
             (automatic.get<std::string>("Threads") == "tied"
                  ? "taken for threads and tied; Threads = contact takes them for fits\n"
                  : "taken for fits; Threads = tied takes them for threads\n");
}

std::string wordsOfPairs(const Assembly& assembly, const std::vector<FacePair>& pairs) {
  std::map<std::string, int> count;
  std::vector<std::string> order;
  for (const FacePair& pair : pairs) {
    const std::string words = partOf(nameOf(assembly, pair.first)) + " - " +
                              partOf(nameOf(assembly, pair.second)) + ": " + assembly.faces[pair.first].kind +
                              " on " + assembly.faces[pair.second].kind + ", area " + text(pair.area, 3) +
                              ", " + gapsOf(pair, assembly.diagonal());
    if (count[words]++ == 0)
      order.push_back(words);
  }
  std::string lines;
  for (const std::string& words : order)
    lines += (count[words] > 1 ? std::to_string(count[words]) + " x " : "") + words + '\n';
  return lines;
}

std::string wordsOfNearMisses(const Assembly& assembly) {
  std::map<std::string, std::pair<int, double>> count; // by the distance as it is shown
  for (const FacePair& pair : assembly.nearMisses) {
    const double gap = std::min(std::abs(pair.leastGap), std::abs(pair.largestGap));
    auto& [number, largest] = count[text(gap, 2)];
    ++number;
    largest = std::max(largest, gap);
  }
  std::string lines;
  for (const auto& [shown, found] : count)
    lines += std::to_string(found.first) +
             (found.first == 1 ? " pair of faces is " : " pairs of faces are ") + shown +
             (assembly.unit.empty() ? "" : " mm") + " apart: a Distance of " + text(1.2 * found.second, 2) +
             " takes " + (found.first == 1 ? "it" : "them") + " in\n";
  return lines;
}

} // namespace epafi::assembly
