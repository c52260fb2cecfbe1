#pragma once

/// Faces and bodies in words, since STEP files name no faces: "lug/cylinder r=10", "bolt M12:*/plane +z",
/// "lug/face 7".

#include "epafi/assembly/Assembly.hpp"

#include <string>
#include <vector>

namespace epafi::assembly {

/// Indices of the solids that a pattern stands for: a name, one with * for any letters, or the beginning of
/// one name. \throws InputError that lists the names if there is none, or several names begin so
std::vector<int> solidsOf(const Assembly& assembly, const std::string& pattern);

/// Indices of faces, at least one. Words are a kind (plane, cylinder, cone, sphere, torus, surface, or face
/// for any), or "face" and its number, and then what must hold: "+z", the direction of a plane's outward
/// normal or, without sign, of a cylinder's axis; "r=6.5"; "z=15", a coordinate of the centre. Up to the last
/// digit that --list shows.
/// \param words  "body/…", or without the body if it is known
/// \param solid  index of the body if it is known, else −1
/// \throws InputError that lists the faces if there is none
std::vector<int> facesOf(const Assembly& assembly, const std::string& words, int solid = -1);

/// The corner that is nearest to "body/point x y z", or none if these words do not name a point.
int cornerOf(const Assembly& assembly, const std::string& words);

/// The shortest words that stand for this face alone, among those of its body: "plane +z".
std::string wordsOf(const Assembly& assembly, int face);

/// A line for each face: words, number, area, centre.
std::string tableOf(const Assembly& assembly);

} // namespace epafi::assembly
