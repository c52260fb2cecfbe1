#include "epafi/assembly/AssemblyReader.hpp"

#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MeshFiles.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>

namespace epafi::assembly {
namespace {

using meshing::GmshSession;

/// The unit of length that the file says first, in words; Gmsh turns it into millimetres.
std::string unitIn(const std::string& file) {
  std::ifstream stream(file);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::erase_if(text, [](unsigned char letter) { return std::isspace(letter) != 0; });
  const std::string names[][2] = {{"CONVERSION_BASED_UNIT('INCH'", "inch"},
                                  {"CONVERSION_BASED_UNIT('FOOT'", "foot"},
                                  {"SI_UNIT(.MILLI.,.METRE.)", "mm"},
                                  {"SI_UNIT(.CENTI.,.METRE.)", "cm"},
                                  {"SI_UNIT($,.METRE.)", "m"}};
  for (const auto& [words, unit] : names)
    if (text.find(words) != std::string::npos)
      return unit;
  return "unknown";
}

std::string kindOf(std::string type) {
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* const kind : {"plane", "cylinder", "cone", "sphere", "torus"})
    if (type == kind)
      return kind;
  return "surface";
}

Face faceOf(const GmshSession& session, int number, int solid) {
  Face face{number, solid, kindOf(session.kindOf(number)), session.measureOf(2, number),
            session.centreOf(number)};
  face.group = "face " + std::to_string(number);
  const std::array<double, 4> bounds = session.boundsOf(number);
  const double u = (bounds[0] + bounds[2]) / 2, v = (bounds[1] + bounds[3]) / 2;
  const GmshSession::FacePoint middle = session.pointsOf(number, {u, v}).front();
  if (face.kind == "plane")
    face.axis = middle.normal;
  if (face.kind != "cylinder" && face.kind != "sphere")
    return face;
  const GmshSession::Curvature curvature = session.curvatureOf(number, u, v);
  face.radius = 1 / curvature.greatest;
  if (face.kind == "cylinder")
    face.axis = curvature.leastDirection;
  // Inside or outside of the material, by where the surface bends to.
  const GmshSession::FacePoint beside = session.pointsOf(number, {(u + bounds[2]) / 2, v}).front();
  double bend = 0;
  for (std::size_t d = 0; d < 3; ++d)
    bend += (beside.point[d] - middle.point[d]) * middle.normal[d];
  for (std::size_t d = 0; d < 3; ++d)
    face.onAxis[d] = middle.point[d] + (bend > 0 ? face.radius : -face.radius) * middle.normal[d];
  return face;
}

Assembly assemblyIn(const GmshSession& session, const std::string& file, const PairSearch& search) {
  Assembly assembly{unitIn(file), {}, {}, {}, {}, {}};
  const std::vector<std::string> names = session.solidNames();
  const std::vector<int> solids = session.solids();
  for (int s = 0; s < std::ssize(solids); ++s) {
    const int number = solids[s];
    assembly.solids.push_back({names[s], session.measureOf(3, number), session.boxOf(3, number)});
    for (const int face : session.boundaryOf(number, 2))
      assembly.faces.push_back(faceOf(session, face, s));
    for (const int corner : session.boundaryOf(number, 0))
      assembly.corners.push_back({corner, s, session.placeOf(corner)});
  }
  findPairs(session, search, assembly);
  return assembly;
}

} // namespace

Assembly readAssembly(const std::string& file, const PairSearch& search, const Comm& comm) {
  constexpr double sizeFactor = 1;
  return assemblyFrom(meshing::textOnAllRanks(
      [&] {
        return meshing::textOfGmsh(file, sizeFactor, {},
                                   [&](const GmshSession& session, const std::string& saved) {
                                     std::ofstream(saved) << textOf(assemblyIn(session, file, search));
                                   });
      },
      comm));
}

} // namespace epafi::assembly
