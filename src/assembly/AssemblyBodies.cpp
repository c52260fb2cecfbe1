#include "epafi/assembly/AssemblyBodies.hpp"

#include "epafi/assembly/FaceWords.hpp"
#include "epafi/assembly/Materials.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>
#include <set>
#include <sstream>

namespace epafi::assembly {
namespace {

using Teuchos::ParameterList;
using Numbers = Teuchos::Array<double>;

/// What one line says of one face or corner, before it is known of which body it becomes a support.
struct Held {
  const Assembly& assembly;
  const std::string& words;
  const Face* face; ///< null: a corner

  [[noreturn]] void refuse(const std::string& value, const std::string& objection) const {
    throw InputError("the support " + inQuotes(words) + " is " + inQuotes(value) + ", but " + objection);
  }
  /// The line about which "radial", "around" and "along" are meant.
  [[nodiscard]] Numbers lineAlong(const Vector3& axis, const Point& start) const {
    const double length = assembly.diagonal();
    Numbers line(start.begin(), start.end());
    for (std::size_t d = 0; d < 3; ++d)
      line.push_back(start[d] + length * axis[d]);
    return line;
  }
  void read(const std::string& value, ParameterList& support) const;
};

void Held::read(const std::string& value, ParameterList& support) const {
  std::istringstream stream(value);
  bool turns = false;
  std::vector<std::string> held;
  for (std::string word; stream >> word;) {
    const std::string own[] = {"radial", "around", "along"};
    const auto about = std::find(std::begin(own), std::end(own), word);
    if (word == "fixed")
      held.insert(held.end(), {"X", "Y", "Z"});
    else if (word == "normal" && face != nullptr)
      held.emplace_back("Normal");
    else if (about != std::end(own) && face != nullptr) {
      turns = true;
      held.emplace_back(1, "XYZ"[about - std::begin(own)]);
      if (face->kind == "cylinder") {
        support.set("Cylinder", lineAlong(face->axis, face->onAxis));
        continue;
      }
      std::string axis;
      stream >> axis;
      const std::size_t d = axis.size() == 1 ? std::string("xyz").find(axis) : std::string::npos;
      if (d == std::string::npos)
        refuse(value, "the face is no cylinder with an axis of its own; name one, \"" + word + " z\"");
      Vector3 along{};
      along[d] = 1;
      support.set("Cylinder", lineAlong(along, face->kind == "sphere" ? face->onAxis : face->centre));
    } else if (word.find_first_not_of("xyz") == std::string::npos &&
               std::set<char>(word.begin(), word.end()).size() == word.size()) {
      for (const char letter : word)
        held.emplace_back(1, static_cast<char>(letter - 'x' + 'X'));
      if (turns)
        refuse(value, "x, y and z do not go with the axis of a cylinder; write two supports");
    } else {
      refuse(value, "\"" + word + "\" is none of fixed, x, y, z" +
                        (face == nullptr ? "" : ", normal, radial, around and along"));
    }
  }
  if (held.empty())
    refuse(value, "that holds nothing");
  for (const std::string& component : held)
    support.set(component, 0.0);
}

class BodyMaker {
public:
  BodyMaker(const Assembly& assembly, std::string& notes) : assembly_(assembly), notes_(notes) {}

  [[nodiscard]] ParameterList& bodyOf(int solid) { return bodies_.sublist(assembly_.solids[solid].name); }
  void begin(const ParameterList& given, const std::string& mesh);
  void setMaterials(const std::string& common);
  void addSupports(const ParameterList& lines);
  void addLoads(const ParameterList& lines, bool isForce);
  [[nodiscard]] const ParameterList& bodies() const { return bodies_; }

private:
  void merge(const ParameterList& given, int solid);
  [[nodiscard]] std::vector<int> found(const std::string& words);
  /// A list of a face's own among the supports or loads of its body.
  ParameterList& entryFor(const std::string& kind, const std::string& words, int solid,
                          const std::string& group);

  const Assembly& assembly_;
  std::string& notes_;
  ParameterList bodies_{"Bodies"};
};

void BodyMaker::begin(const ParameterList& given, const std::string& mesh) {
  for (int s = 0; s < std::ssize(assembly_.solids); ++s)
    bodyOf(s).set("Physics", "elasticity 3-D").set("Mesh", mesh).set("Group", assembly_.solids[s].name);
  for (const auto& entry : given) {
    if (!entry.second.isList())
      throw InputError("list \"Bodies\" holds the parameter " + inQuotes(entry.first) +
                       ", but must hold lists, one a body");
    for (const int solid : solidsOf(assembly_, entry.first))
      merge(Teuchos::getValue<ParameterList>(entry.second), solid);
  }
}

/// Supports and loads name surfaces in words, which may be several.
void BodyMaker::merge(const ParameterList& given, int solid) {
  ParameterList own = given;
  for (const char* const kind : {"Supports", "Loads"}) {
    if (!own.isSublist(kind))
      continue;
    const ParameterList entries = own.sublist(kind);
    own.remove(kind);
    for (const auto& entry : entries) {
      const bool isList = entry.second.isList(); // if not, that is told where the scene is checked
      const ParameterList list = isList ? Teuchos::getValue<ParameterList>(entry.second) : ParameterList();
      if (!list.isType<std::string>("Surface")) {
        own.sublist(kind).setEntry(entry.first, entry.second);
        continue;
      }
      for (const int face : facesOf(assembly_, list.get<std::string>("Surface"), solid)) {
        const std::string group = assembly_.faces[face].group;
        own.sublist(kind).sublist(entry.first + ", " + group).setParameters(list).set("Surface", group);
      }
    }
  }
  bodyOf(solid).setParameters(own);
}

void BodyMaker::setMaterials(const std::string& common) {
  for (int s = 0; s < std::ssize(assembly_.solids); ++s) {
    ParameterList& body = bodyOf(s);
    const std::string name = body.isParameter("Material") ? body.get<std::string>("Material") : common;
    body.remove("Material", false);
    if (body.isParameter("Young's Modulus") || body.isParameter("Elasticity"))
      continue;
    if (name.empty())
      throw InputError("body " + inQuotes(assembly_.solids[s].name) +
                       " has no material; say what all are made of in list \"Assembly\", Material = steel "
                       "say, or what this one is in list \"Bodies\"");
    const NamedMaterial& material = materialOf(name);
    body.set("Young's Modulus", material.youngsModulus)
        .set("Poisson's Ratio", material.poissonsRatio)
        .set("Expansion", material.expansion);
  }
}

std::vector<int> BodyMaker::found(const std::string& words) {
  const std::vector<int> faces = facesOf(assembly_, words);
  std::vector<std::string> names;
  for (const int face : faces)
    names.push_back(assembly_.faces[face].group);
  if (const std::string note = inQuotes(words) + " is " + listed(names) + '\n';
      notes_.find(note) == std::string::npos)
    notes_ += note;
  return faces;
}

ParameterList& BodyMaker::entryFor(const std::string& kind, const std::string& words, int solid,
                                   const std::string& group) {
  const std::string name = words.substr(words.rfind('/') + 1);
  return bodyOf(solid)
      .sublist(kind)
      .sublist(name == group ? name : name + ", " + group)
      .set("Surface", group);
}

void BodyMaker::addSupports(const ParameterList& lines) {
  for (const auto& line : lines) {
    const std::string& words = line.first;
    if (!line.second.isType<std::string>())
      throw InputError("the support " + inQuotes(words) + " must be a string, \"fixed\" or \"xy\" say");
    const auto value = Teuchos::getValue<std::string>(line.second);
    if (const int c = cornerOf(assembly_, words); c >= 0) {
      const Corner& corner = assembly_.corners[c];
      Held{assembly_, words, nullptr}.read(
          value, entryFor("Supports", words, corner.solid, "point " + std::to_string(corner.number)));
      continue;
    }
    for (const int f : found(words)) {
      const Face& face = assembly_.faces[f];
      Held{assembly_, words, &face}.read(value, entryFor("Supports", words, face.solid, face.group));
    }
  }
}

/// Pressures, and forces spread over all faces that the words mean.
void BodyMaker::addLoads(const ParameterList& lines, bool isForce) {
  for (const auto& line : lines) {
    const std::string& words = line.first;
    if (isForce ? !line.second.isType<Numbers>() || Teuchos::getValue<Numbers>(line.second).size() != 3
                : !line.second.isType<double>())
      throw InputError("the " + std::string(isForce ? "force " : "pressure ") + inQuotes(words) +
                       " must be " + (isForce ? "an Array(double) {x, y, z}" : "a double"));
    const std::vector<int> faces = found(words);
    double area = 0;
    for (const int face : faces)
      area += assembly_.faces[face].area;
    for (const int f : faces) {
      const Face& face = assembly_.faces[f];
      ParameterList& load = entryFor("Loads", words, face.solid, face.group);
      load.set("Kind", isForce ? "traction" : "pressure");
      if (!isForce) {
        load.set("Value", Teuchos::getValue<double>(line.second));
        continue;
      }
      Numbers traction = Teuchos::getValue<Numbers>(line.second);
      for (double& component : traction)
        component /= area;
      load.set("Force", traction);
    }
  }
}

} // namespace

ParameterList bodiesOf(const Assembly& assembly, const ParameterList& given,
                       const ParameterList& assemblyList, const std::string& mesh, std::string& notes) {
  BodyMaker maker(assembly, notes);
  maker.begin(given, mesh);
  maker.setMaterials(assemblyList.get<std::string>("Material"));
  maker.addSupports(assemblyList.sublist("Supports"));
  maker.addLoads(assemblyList.sublist("Forces"), true);
  maker.addLoads(assemblyList.sublist("Pressures"), false);
  return maker.bodies();
}

} // namespace epafi::assembly
