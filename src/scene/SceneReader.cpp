#include "epafi/scene/SceneReader.hpp"

#include "epafi/base/Errors.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>
#include <sstream>

namespace epafi::scene {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

class Reader {
public:
  Reader(const ParameterList& given, std::string where) : given_(given), where_(std::move(where)) {}

  Scene read(const ParameterList& list) {
    scene_.title = list.get<std::string>("Title");
    const ParameterList& bodies = list.sublist("Bodies");
    for (auto entry = bodies.begin(); entry != bodies.end(); ++entry)
      scene_.bodies.push_back(readBody(bodies.sublist(bodies.name(entry)), bodies.name(entry), list));
    if (scene_.bodies.empty())
      throw InputError(where_ + ": list 'Bodies' has no body; give at least one");
    const ParameterList& contacts = list.sublist("Contact");
    for (auto entry = contacts.begin(); entry != contacts.end(); ++entry)
      readContact(contacts.sublist(contacts.name(entry)), contacts.name(entry));
    return scene_;
  }

private:
  [[noreturn]] void refuse(const std::string& list, const std::string& parameter, const std::string& what) const {
    throw InputError(where_ + ": parameter '" + parameter + "' in list '" + list + "' " + what);
  }

  Rectangle readBox(const ParameterList& list, const std::string& path, const std::string& name) const {
    const auto values = list.get<Array<double>>(name);
    if (values.size() != 4)
      refuse(path, name, "has " + std::to_string(values.size()) + " numbers but must be {x0, x1, y0, y1}");
    const Rectangle box{values[0], values[1], values[2], values[3]};
    if (!(box.x0 < box.x1) || !(box.y0 < box.y1))
      refuse(path, name, "is " + values.toString() + " but must have x0 < x1 and y0 < y1 (positive size)");
    return box;
  }

  Rectangle readBoxIn(const Body& body, const ParameterList& list, const std::string& path) const {
    const Rectangle box = readBox(list, path, "Box");
    const Rectangle& r = body.rectangle;
    if (box.x1 <= r.x0 || box.x0 >= r.x1 || box.y1 <= r.y0 || box.y0 >= r.y1)
      refuse(path, "Box", "is " + list.get<Array<double>>("Box").toString() + " and misses the body '" + body.name + "'");
    return box;
  }

  std::array<int, 2> readCounts(const ParameterList& list, const std::string& path, const std::string& name) const {
    const auto values = list.get<Array<int>>(name);
    if (values.size() != 2)
      refuse(path, name, "has " + std::to_string(values.size()) + " numbers but must be {in x, in y}");
    if (values[0] < 1 || values[1] < 1)
      refuse(path, name, "is " + values.toString() + " but both numbers must be at least 1");
    return {values[0], values[1]};
  }

  static Edge edgeOf(const std::string& name) {
    for (const Edge edge : {Edge::left, Edge::right, Edge::bottom})
      if (toString(edge) == name)
        return edge;
    return Edge::top;
  }

  Body readBody(const ParameterList& list, const std::string& name, const ParameterList& all) const {
    const std::string path = "Bodies/" + name;
    Body body;
    body.name = name;
    body.rectangle = readBox(list, path, "Rectangle");
    body.elements = readCounts(list, path, "Elements");
    if ((static_cast<double>(body.elements[0]) + 1) * (static_cast<double>(body.elements[1]) + 1) > 2147483647.0)
      refuse(path, "Elements", "is " + list.get<Array<int>>("Elements").toString() +
                                   ": a body may have at most 2147483647 nodes");
    body.conductivity = list.get<double>("Conductivity");
    readRegions(list.sublist("Regions"), path + "/Regions/", body);
    readSupports(list.sublist("Supports"), path + "/Supports", body);
    readLoads(list.sublist("Loads"), path + "/Loads/", body);
    body.decomposition = readDecomposition(list, name, all);
    return body;
  }

  void readRegions(const ParameterList& list, const std::string& path, Body& body) const {
    for (auto entry = list.begin(); entry != list.end(); ++entry) {
      const std::string& name = list.name(entry);
      const ParameterList& region = list.sublist(name);
      body.regions.push_back({name, readBoxIn(body, region, path + name), region.get<double>("Conductivity")});
    }
  }

  void readSupports(const ParameterList& list, const std::string& path, Body& body) const {
    for (auto entry = list.begin(); entry != list.end(); ++entry) {
      const std::string& name = list.name(entry);
      const Edge edge = edgeOf(list.sublist(name).get<std::string>("Edge"));
      for (const Support& other : body.supports)
        if (other.edge == edge)
          refuse(path + "/" + name, "Edge",
                 "is " + toString(edge) + ", an edge that support '" + other.name + "' holds already");
      body.supports.push_back({name, edge, list.sublist(name).get<double>("Value")});
    }
  }

  void readLoads(const ParameterList& list, const std::string& path, Body& body) const {
    for (auto entry = list.begin(); entry != list.end(); ++entry) {
      const std::string& name = list.name(entry);
      const ParameterList& load = list.sublist(name);
      const bool isEverywhere = load.get<Array<double>>("Box").size() == 0;
      const Rectangle box = isEverywhere ? body.rectangle : readBoxIn(body, load, path + name);
      body.loads.push_back({name, box, load.get<double>("Value")});
    }
  }

  /// What the body says itself, else what the scene says for all.
  Decomposition readDecomposition(const ParameterList& body, const std::string& name, const ParameterList& all) const {
    const std::string path = "Bodies/" + name;
    const auto source = [&](const std::string& parameter) -> const ParameterList& {
      const ParameterList& bodies = given_.sublist("Bodies");
      const bool isOwn = bodies.isSublist(name) && bodies.sublist(name).isSublist("Decomposition") &&
                         bodies.sublist(name).sublist("Decomposition").isParameter(parameter);
      return (isOwn ? body : all).sublist("Decomposition");
    };
    Decomposition cut;
    const bool isGrid = source("Method").get<std::string>("Method") == "grid";
    cut.method = isGrid ? Decomposition::Method::grid : Decomposition::Method::metis;
    cut.counts = readCounts(source("Grid"), path + "/Decomposition", "Grid");
    cut.parts = source("Parts").get<int>("Parts");
    const auto elements = body.get<Array<int>>("Elements");
    if (isGrid && (cut.counts[0] > elements[0] || cut.counts[1] > elements[1]))
      refuse(path + "/Decomposition", "Grid",
             "is {" + std::to_string(cut.counts[0]) + ", " + std::to_string(cut.counts[1]) +
                 "} but the body has only " + elements.toString() + " elements");
    if (!isGrid && static_cast<double>(cut.parts) > static_cast<double>(elements[0]) * elements[1])
      refuse(path + "/Decomposition", "Parts",
             "is " + std::to_string(cut.parts) + " but the body has only " + elements.toString() + " elements");
    return cut;
  }

  int bodyIndex(const ParameterList& list, const std::string& path, const std::string& parameter) const {
    const auto name = list.get<std::string>(parameter);
    std::vector<std::string> names;
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      names.push_back(scene_.bodies[b].name);
      if (names.back() == name)
        return static_cast<int>(b);
    }
    if (name.empty())
      refuse(path, parameter, "is missing; name one of the bodies");
    const std::string near = nearestName(name, names);
    refuse(path, parameter, "is '" + name + "', which is no body" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }

  void requireUnused(int body, Edge edge, const std::string& path, const std::string& parameter) const {
    const Body& owner = scene_.bodies[static_cast<std::size_t>(body)];
    for (const Support& support : owner.supports)
      if (support.edge == edge)
        refuse(path, parameter,
               "is " + toString(edge) + ", but support '" + support.name + "' of body '" + owner.name +
                   "' holds that edge: supports and contact may not overlap");
    for (const ContactPair& other : scene_.contacts)
      if ((other.first == body && other.firstEdge == edge) || (other.second == body && other.secondEdge == edge))
        refuse(path, parameter,
               "is " + toString(edge) + ", an edge of body '" + owner.name + "' that pair '" + other.name + "' uses already");
  }

  void readContact(const ParameterList& list, const std::string& name) {
    const std::string path = "Contact/" + name;
    ContactPair pair;
    pair.name = name;
    pair.first = bodyIndex(list, path, "First Body");
    pair.second = bodyIndex(list, path, "Second Body");
    if (pair.first == pair.second)
      refuse(path, "Second Body", "is the first body too: a body makes no contact with itself");
    pair.firstEdge = edgeOf(list.get<std::string>("First Edge"));
    pair.secondEdge = edgeOf(list.get<std::string>("Second Edge"));
    pair.gap = list.get<double>("Gap");
    requireUnused(pair.first, pair.firstEdge, path, "First Edge");
    requireUnused(pair.second, pair.secondEdge, path, "Second Edge");
    scene_.contacts.push_back(pair);
  }

  const ParameterList& given_;
  std::string where_;
  Scene scene_;
};

} // namespace

Scene readScene(const ParameterList& list, const ParameterList& given, const std::string& where) {
  return Reader(given, where).read(list);
}

} // namespace epafi::scene
