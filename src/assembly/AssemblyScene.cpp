#include "epafi/assembly/AssemblyScene.hpp"

#include "epafi/assembly/AssemblyBodies.hpp"
#include "epafi/assembly/AssemblyPairs.hpp"
#include "epafi/assembly/AssemblySchema.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/meshing/MeshSource.hpp"

#include <Teuchos_Array.hpp>

namespace epafi::assembly {
namespace {

using Teuchos::ParameterList;

/// A sublist, or an empty one.
ParameterList sublistOf(const ParameterList& list, const std::string& name) {
  if (list.isParameter(name) && !list.isSublist(name))
    throw InputError(inQuotes(name) + " is a parameter, but must be a list");
  return list.isSublist(name) ? list.sublist(name) : ParameterList(name);
}

ParameterList automaticIn(const ParameterList& given, const std::string& where) {
  return validated(sublistOf(sublistOf(given, "Contact"), "Automatic"), automaticSchema(),
                   where + ": list \"Contact/Automatic\"");
}

/// Validated but for what stands under faces of the user's choice.
ParameterList assemblyListIn(const ParameterList& given, const std::string& where) {
  const ParameterList whole = sublistOf(given, "Assembly");
  ParameterList list = whole, schema = assemblySchema(), lines;
  for (const char* const name : {"Supports", "Forces", "Pressures"}) {
    lines.sublist(name).setParameters(sublistOf(whole, name));
    for (ParameterList* const part : {&list, &schema})
      part->remove(name, false);
  }
  list = validated(list, schema, where + ": list \"Assembly\"");
  list.setParameters(lines);
  return list;
}

/// Of the elements, unless bodies say so themselves: for gaps of cylinders in bores, and where balls touch.
void setSizes(const Assembly& assembly, const ParameterList& assemblyList, ParameterList& bodies) {
  const int around = elementsAroundFor(assembly);
  const auto size = assemblyList.get<double>("Contact Size");
  Teuchos::Array<double> points;
  for (const FacePair& pair : assembly.pairs)
    if (size > 0 && isPoint(assembly, pair)) {
      for (const double coordinate : pair.closest)
        points.push_back(coordinate);
      points.push_back(size);
    }
  for (auto body = bodies.begin(); body != bodies.end(); ++body) {
    ParameterList& list = bodies.sublist(body->first);
    if (around > meshing::StepSizes().elementsAround && !list.isParameter("Elements Around"))
      list.set("Elements Around", around);
    if (!points.empty() && !list.isParameter("Fine Points"))
      list.set("Fine Points", points);
  }
}

/// Adds the file's name to what is said of a part of it.
template <class Work>
auto in(const std::string& where, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(where + ": " + asSentence(error.what()));
  }
}

} // namespace

PairSearch pairSearchIn(const ParameterList& given, const std::string& where) {
  const ParameterList automatic = automaticIn(given, where);
  return {automatic.get<double>("Distance"), automatic.get<double>("Angle")};
}

std::string overviewOf(const Assembly& assembly) {
  const auto [lower, upper] = assembly.box();
  return std::to_string(assembly.solids.size()) + " bodies with " + std::to_string(assembly.faces.size()) +
         " faces" + (assembly.unit.empty() ? "" : ", in mm (file: " + assembly.unit + "), N and MPa") +
         "; box " + text(lower, 4) + " to " + text(upper, 4) + '\n';
}

ParameterList pairsOf(const Assembly& assembly, const ParameterList& given, const std::string& where,
                      std::string& notes) {
  const ParameterList automatic = automaticIn(given, where);
  ParameterList pairs = sublistOf(given, "Contact");
  pairs.remove("Automatic", false);
  return in(where, [&] { return contactsOf(assembly, pairs, automatic, notes); });
}

ParameterList pairsOf(std::span<const MeshedBody> bodies, const MeshFaces& faces, const ParameterList& given,
                      const std::string& where, std::string& notes) {
  const ParameterList automatic = automaticIn(given, where);
  ParameterList contacts = sublistOf(given, "Contact");
  contacts.setName("Contact");
  contacts.remove("Automatic", false);
  FacesInPairs known;
  const auto facesAt = [&](const ParameterList& pair, const std::string& side) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (pair.isType<std::string>(side + " Surface") && pair.isType<std::string>(side + " Body") &&
          pair.get<std::string>(side + " Body") == bodies[b].name)
        return faces.facesIn(bodies, static_cast<int>(b), pair.get<std::string>(side + " Surface"));
    return std::vector<int>();
  };
  for (const auto& entry : contacts) {
    const auto& pair = Teuchos::getValue<ParameterList>(entry.second);
    for (const int first : facesAt(pair, "First"))
      for (const int second : facesAt(pair, "Second"))
        known.insert(std::minmax(first, second));
  }
  return in(where, [&] {
    addFoundPairs(faces.assembly, automatic, known, contacts, notes);
    return contacts;
  });
}

AssemblyScene sceneOf(const Assembly& assembly, const ParameterList& given, const std::string& mesh,
                      const std::string& where) {
  const ParameterList assemblyList = assemblyListIn(given, where);
  AssemblyScene result{given, overviewOf(assembly)};
  result.scene.remove("Assembly", false);
  ParameterList bodies = in(where, [&] {
    return bodiesOf(assembly, sublistOf(given, "Bodies"), assemblyList, mesh, result.notes);
  });
  setSizes(assembly, assemblyList, bodies);
  const ParameterList contacts = pairsOf(assembly, given, where, result.notes);
  for (const ParameterList& part : {bodies, contacts}) {
    result.scene.remove(part.name(), false);
    result.scene.sublist(part.name()).setParameters(part);
  }
  return result;
}

} // namespace epafi::assembly
