#pragma once

/// The records of CalculiX' result format (.frd, ASCII, long), each with its columns.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Cell.hpp"

#include <span>
#include <string>

namespace epafi::output {

/// The head of a file. \param bodies  their names, which stand as those of materials 1, 2, …
void putFrdStart(std::string& text, std::span<const std::string> bodies);

/// "2C", how many nodes come, or "3C", how many elements.
void putFrdSize(std::string& text, const char* key, GlobalOrdinal number);

/// A node's number with its place or its results, at most six. Values are those that a `float` can have, as
/// in CalculiX, so that exponents have two digits.
void putFrdNode(std::string& text, GlobalOrdinal number, std::span<const double> values);

/// An element. \param nodes  numbers of all its nodes, in the order of mesh/Cell.hpp; those inside faces and
/// itself are left out, as the format has none
/// \throws Error if cells of the type are no elements of bodies.
void putFrdElement(std::string& text, GlobalOrdinal number, int material, mesh::CellType type,
                   std::span<const GlobalOrdinal> nodes);

/// The end of nodes, elements or results.
void putFrdEnd(std::string& text);

/// What results are: names and kinds of their components, line by line.
extern const char *const frdDisplacement, *const frdStress, *const frdStrain, *const frdForce,
                                                                                  *const frdContact;

/// Where in a file results are.
struct FrdPlace {
  int block = 0;     ///< from 1 on
  int increment = 0; ///< from 1 on: which of the load steps in the file
  int step = 1;      ///< number of this in the scene, which is the results' time
  std::string name;  ///< of the step; perhaps empty
};

/// What stands before the results at some nodes. \param kind  one of the above
void putFrdHead(std::string& text, const FrdPlace& place, GlobalOrdinal numNodes, const char* kind);

} // namespace epafi::output
