#pragma once

/// Gmsh at work on one file. Its library is loaded when first needed.

#include "epafi/mesh/SizeField.hpp"

#include <string>
#include <vector>

namespace epafi::meshing {

/// Loads Gmsh's library. \throws Error if there is none
void loadGmsh();

/// From initialisation to its end: silent, with no configuration of the user read. One at a time, and in a
/// process of its own (ChildProcess.hpp): geometries are programs that can end it. All functions throw
/// InputError with the file's name and Gmsh's own first message where Gmsh has an error to tell of.
class GmshSession {
public:
  explicit GmshSession(std::string file);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  void open(double meshSizeFactor) const;
  /// Whether the shape of anything is that of a mesh: of an STL file, or of a mesh that the geometry merges.
  /// Without that mesh it has none.
  [[nodiscard]] bool isDiscrete() const;
  /// Elements that the file does not make itself, split so many times, of an order unless it is 0.
  void mesh(int refinements, int order) const;
  /// In simplices of given sizes, in the lengths of what is saved, and of order 2. Precondition: not
  /// isDiscrete()
  void meshWith(const mesh::SizeField& sizes) const;
  /// Throws InputError if elements of the highest dimension are of a kind that is not known.
  void requireKnown() const;
  /// Saves all there is, whatever the file says of how and what to save, but in the lengths that it says.
  void save(const std::string& file) const;

private:
  [[nodiscard]] std::vector<int> elementTypes(int dimension) const;
  /// Throws if Gmsh has told of an error.
  void check(int error) const;
  /// Calls a function and adds its last argument.
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) const;

  std::string file_;
};

} // namespace epafi::meshing
