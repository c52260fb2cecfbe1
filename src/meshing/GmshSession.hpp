#pragma once

/// Gmsh at work on one file. Its library is loaded when first needed.

#include "epafi/mesh/Box.hpp"
#include "epafi/mesh/SizeField.hpp"
#include "epafi/meshing/MeshSource.hpp"

#include <array>
#include <optional>
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

  /// The solids of a STEP file become groups, called as solidNames() says, its faces and corners "face 1" and
  /// "point 1", and so on. \param sizes  of such a file
  void open(double meshSizeFactor, const StepSizes& sizes = {}) const;
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

  /// What a STEP file describes, by Gmsh's numbers of solids, faces and corners (dimensions 3, 2 and 0).
  [[nodiscard]] std::vector<int> solids() const;
  /// By their instances, "bolt M12:3"; "solid 1" where the file has no name. None twice.
  [[nodiscard]] std::vector<std::string> solidNames() const;
  [[nodiscard]] std::vector<int> boundaryOf(int solid, int dimension) const;
  [[nodiscard]] std::string kindOf(int face) const; ///< "Plane", "Cylinder", "Sphere", …
  [[nodiscard]] Point placeOf(int corner) const;
  [[nodiscard]] double measureOf(int dimension, int number) const; ///< volume or area
  [[nodiscard]] Point centreOf(int face) const;                    ///< of area
  [[nodiscard]] mesh::Box boxOf(int dimension, int number) const;
  [[nodiscard]] std::array<double, 4> boundsOf(int face) const; ///< u0, v0, u1, v1 of its parameters
  /// A point of a face, the normal out of its solid, and area over that of the parameters.
  struct FacePoint {
    Point point;
    Vector3 normal;
    double stretch;
  };
  /// \param parameters  u and v of each
  [[nodiscard]] std::vector<FacePoint> pointsOf(int face, std::vector<double> parameters) const;
  /// Whether the point of the surface belongs to the face, which may have holes.
  [[nodiscard]] bool isInside(int face, double u, double v) const;
  /// The points of a face's surface, endless or not, that are closest to points.
  [[nodiscard]] std::vector<Point> closestOn(int face, const std::vector<Point>& points) const;
  /// u and v of such a point; nothing if it is far outside of the face.
  [[nodiscard]] std::optional<std::array<double, 2>> parametersOf(int face, Point point) const;
  struct Curvature {
    double greatest, least; ///< magnitudes
    Vector3 leastDirection;
  };
  [[nodiscard]] Curvature curvatureOf(int face, double u, double v) const;

private:
  void nameShapes() const;
  void setStepSizes(const StepSizes& sizes) const;
  [[nodiscard]] std::vector<int> elementTypes(int dimension) const;
  /// Throws if Gmsh has told of an error.
  void check(int error) const;
  /// Calls a function and adds its last argument.
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) const;

  std::string file_;
};

} // namespace epafi::meshing
