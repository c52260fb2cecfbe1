#pragma once

/// Values out of a validated list, with error sentences that name file, list, parameter and value.

#include "epafi/scene/Scene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

namespace epafi::scene {

/// A list of a scene and the place where it stands. Keeps references: list and file name must outlive it.
/// Every function throws InputError; none is collective.
class ListReader {
public:
  /// \param list  validated against its schema: all parameters are there and have their types
  /// \param file  with what messages begin
  /// \param path  names of the lists around and of this one, "Bodies/left"
  ListReader(const Teuchos::ParameterList& list, const std::string& file, std::string path)
      : list_(list), file_(file), path_(std::move(path)) {}

  [[nodiscard]] ListReader inside(const std::string& name) const;
  /// Names of the entries, in the file's order.
  [[nodiscard]] std::vector<std::string> names() const;
  /// Whether the parameter is given rather than a default.
  [[nodiscard]] bool has(const std::string& name) const { return !list_.getEntry(name).isDefault(); }
  /// Whether an array or a word is given and is not empty.
  [[nodiscard]] bool hasEntries(const std::string& name) const;

  /// A real number: 0, or of a magnitude that can be squared, 1e-30 … 1e30.
  [[nodiscard]] double real(const std::string& name) const;
  /// A number that the schema allows to be positive only, 1e-30 … 1e30.
  [[nodiscard]] double positive(const std::string& name) const;
  [[nodiscard]] int integer(const std::string& name) const { return list_.get<int>(name); }
  [[nodiscard]] const std::string& word(const std::string& name) const {
    return list_.get<std::string>(name);
  }
  /// A word that names an edge of a rectangle.
  [[nodiscard]] const std::string& edge(const std::string& name) const;
  /// {x0, x1, y0, y1} in the plane, {x0, x1, y0, y1, z0, z1} in space, of positive size; coordinates as
  /// real(), sides 1e-30 … 1e30. In the plane z is unbounded.
  [[nodiscard]] mesh::Box box(const std::string& name, int dimension) const;
  /// {nx, ny} in the plane, {nx, ny, nz} in space, each ≥ 1; nz = 1 in the plane.
  [[nodiscard]] std::array<int, 3> counts(const std::string& name, int dimension) const;
  /// {x, y} or {x, y, z}, as real(); z = 0 in the plane.
  [[nodiscard]] Vector3 vector(const std::string& name, int dimension) const;
  /// {x, y, z, x, y, z}, as real(): two vectors in space.
  [[nodiscard]] std::array<Vector3, 2> vectors(const std::string& name) const;
  /// As many as there are, each as real().
  [[nodiscard]] std::vector<double> reals(const std::string& name) const;
  /// Number of entries of an array of real numbers.
  [[nodiscard]] int length(const std::string& name) const;
  /// The file that a word names: beside the scene's file unless the path is absolute.
  [[nodiscard]] std::string file(const std::string& name) const;

  /// Throws unless the parameter is given. \param needs  why it must be, "which … must have"
  void require(const std::string& name, const std::string& needs = "") const;
  /// Throws if one of the parameters is given. \param reason  follows "but "
  void refuseGiven(std::initializer_list<const char*> names, const std::string& reason) const;
  /// Throws: 'file: parameter "name" in list "path" is value, but `objection`.' No full stop follows a '?'.
  [[noreturn]] void refuseValue(const std::string& name, const std::string& objection) const;
  /// Throws: 'file: list "path" `objection`.'
  [[noreturn]] void refuseList(const std::string& objection) const;

private:
  void requireLength(const std::string& name, int expected, const std::string& form) const;
  void requireModerate(const std::string& name) const;

  const Teuchos::ParameterList& list_;
  const std::string& file_;
  std::string path_;
};

} // namespace epafi::scene
