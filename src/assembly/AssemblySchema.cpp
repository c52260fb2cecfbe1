#include "epafi/assembly/AssemblySchema.hpp"

#include "epafi/assembly/Materials.hpp"
#include "epafi/assembly/PairSearch.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"

#include <string>
#include <vector>

namespace epafi::assembly {

using Teuchos::ParameterList;

namespace {

std::vector<std::string> materialNames() {
  std::vector<std::string> names;
  for (const NamedMaterial& material : materials())
    names.push_back(material.name);
  return names;
}

} // namespace

ParameterList assemblySchema() {
  ParameterList list("Assembly");
  addChoice(list, "Material", "",
            "What bodies are made of that say nothing else. A name stands for Young's Modulus (MPa), "
            "Poisson's Ratio and Expansion of the usual sort.",
            materialNames());
  addReal(list, "Contact Size", 0.0,
          "Size of the elements where faces touch in a point, a third of the radius that is in contact say; "
          "0: as "
          "elsewhere.",
          0.0);
  list.sublist("Supports", false, "Where bodies are held.")
      .set("<face>", "",
           "Under the face in words, \"lug/plane -z\": \"fixed\"; \"xy\", these components; \"normal\", the "
           "face slides along itself; of a cylinder \"radial\", \"around\" or \"along\" its axis, one or "
           "more; "
           "of another face \"around z\", a line through its centre. What is held around alone "
           "may breathe. A corner is a face, too: \"lug/point 30 -7.5 0\".");
  addArray(list.sublist("Forces", false, "Forces on faces."), "<face>", Teuchos::Array<double>(),
           "Under the face in words: the force on all of it in N, {x, y, z}, spread evenly; on all faces "
           "together where the words mean several.",
           "");
  addReal(list.sublist("Pressures", false, "Pressures on faces."), "<face>", 0.0,
          "Under the face in words: the pressure in MPa.");
  return list;
}

ParameterList automaticSchema() {
  ParameterList list("Automatic");
  addReal(
      list, "Distance", PairSearch().distance,
      "Up to which distance faces of two bodies are a pair; 0: a thousandth of the diagonal of all bodies.",
      0.0);
  addReal(list, "Angle", PairSearch().angle,
          "Degrees: by how much the outward normals of both may differ from being opposite.", 0.0, 90.0);
  addChoice(list, "Kind", "contact", "What pairs are, but for threads.", {"contact", "tied"});
  addChoice(list, "Threads", "tied",
            "Of a STEP file: what pairs of cylinders are that coincide, as bolts and nuts do that are drawn "
            "without threads; a fit would be a contact.",
            {"tied", "contact"});
  addReal(list, "Friction", 0.0, "Coulomb's coefficient of pairs in contact.", 0.0);
  list.set("Exclude", "",
           "Pairs that are left out, parted by commas: bodies or faces, one (\"bolt M12:*\") or both "
           "(\"nut M12:1/plane +z - lower flange\").");
  return list;
}

ParameterList withAutomatic(ParameterList schema) {
  schema.sublist("Contact")
      .sublist("Automatic", false,
               "How pairs of faces are found: always of a STEP file, of other scenes if the list is there. "
               "Pairs that are given by hand win.")
      .setParameters(automaticSchema());
  return schema;
}

ParameterList withAssembly(ParameterList schema) {
  schema
      .sublist(
          "Assembly", false,
          "What a STEP file does not say: `epafi assembly.step scene.xml`. Lengths are mm and moduli MPa "
          "then, bodies those of the file. A body under Bodies stands for all whose names it fits, with "
          "* for any letters. Faces are given in words wherever a surface is named: a kind, and what "
          "tells it from others, as epafi assembly.step --list shows it.")
      .setParameters(assemblySchema());
  ParameterList& body = schema.sublist("Bodies").sublist("<body>");
  addChoice(body, "Material", "", "Of a STEP file: what the body is made of, see Assembly.", materialNames());
  return withAutomatic(schema);
}

} // namespace epafi::assembly
