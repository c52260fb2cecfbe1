#include "FacePicture.hpp"

#include "epafi/base/ArrayIndex.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace epafi::drivers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double viewWidth = 700, viewHeight = 640, viewMargin = 20; ///< of a view

/// A piece of the picture.
struct Patch {
  int face;                      ///< −1: the inside of a plane body
  std::vector<Vector2d> corners; ///< on the paper
  std::vector<char> isRim;       ///< whether the line behind each corner ends the face
  double depth, light;
};

Vector3d vectorAt(const mesh::Mesh& mesh, GlobalOrdinal node) {
  const Point point = mesh.point(node);
  return {point[0], point[1], point[2]};
}

/// The way one looks, and the paper.
struct View {
  Eigen::Matrix3d axes; ///< rows: to the right, up, towards the eye
  double scale = 1;
  Vector2d origin{0, 0};

  static View along(const Vector3d& towardsEye) {
    View view;
    const Vector3d eye = towardsEye.normalized(), right = Vector3d::UnitZ().cross(eye).normalized();
    view.axes << right.transpose(), eye.cross(right).transpose(), eye.transpose();
    return view;
  }
  [[nodiscard]] Vector2d onPaper(const Vector3d& x) const {
    const Vector2d seen = scale * (axes * x).head<2>();
    return {origin.x() + seen.x(), origin.y() - seen.y()};
  }
  /// Fits a box.
  void fit(const mesh::Box& box, double left) {
    Vector2d least(1e300, 1e300), most = -least;
    for (int corner = 0; corner < 8; ++corner) {
      Vector3d x;
      for (int d = 0; d < 3; ++d)
        x[d] = ((corner >> d) & 1) != 0 ? box.upper[index(d)] : box.lower[index(d)];
      const Vector2d seen = (axes * x).head<2>();
      least = least.cwiseMin(seen);
      most = most.cwiseMax(seen);
    }
    const Vector2d size = (most - least).cwiseMax(1e-300);
    scale = std::min((viewWidth - 2 * viewMargin) / size.x(), (viewHeight - 2 * viewMargin) / size.y());
    origin = {left + viewWidth / 2 - scale * (least.x() + most.x()) / 2,
              viewHeight / 2 + scale * (least.y() + most.y()) / 2};
  }
};

std::string colourOf(int body, double light, bool isPaired) {
  constexpr double golden = 137.508; // degrees: neighbours are far apart
  std::ostringstream text;
  text << "hsl(" << static_cast<int>(std::fmod(210 + golden * body, 360)) << ' ' << (isPaired ? 85 : 40)
       << "% " << static_cast<int>((isPaired ? 30 : 55) + 25 * light) << "%)";
  return text.str();
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text)
    result += letter == '&' ? "&amp;" : letter == '<' ? "&lt;" : std::string(1, letter);
  return result;
}

bool isInside(const Patch& patch, const Vector2d& x) {
  bool inside = false;
  for (std::size_t i = 0, j = patch.corners.size() - 1; i < patch.corners.size(); j = i++) {
    const Vector2d &a = patch.corners[i], &b = patch.corners[j];
    if ((a.y() > x.y()) != (b.y() > x.y()) &&
        x.x() < a.x() + (b.x() - a.x()) * (x.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

Vector2d centreOf(const Patch& patch) {
  Vector2d sum(0, 0);
  for (const Vector2d& corner : patch.corners)
    sum += corner;
  return sum / static_cast<double>(patch.corners.size());
}

double areaOf(const Patch& patch) {
  double twice = 0;
  for (std::size_t i = 0; i < patch.corners.size(); ++i) {
    const Vector2d &a = patch.corners[i], &b = patch.corners[(i + 1) % patch.corners.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

class Picture {
public:
  Picture(const assembly::MeshFaces& faces, std::span<const mesh::Mesh* const> meshes)
      : faces_(faces), meshes_(meshes) {
    for (const assembly::FacePair& pair : faces.assembly.pairs)
      paired_.insert({pair.first, pair.second});
  }

  std::string make();

private:
  [[nodiscard]] const mesh::Mesh& meshOf(int face) const {
    return *meshes_[index(faces_.faces[index(face)].body)];
  }
  void addFace(const View& view, int face, std::vector<Patch>& patches) const;
  void addInside(const View& view, int body);
  void addView(const View& view);
  void draw(const Patch& patch);
  void addNumbers(const std::vector<Patch>& patches);
  void addEdges(const View& view, int face);
  void addName(int face);
  void addNumber(const Vector2d& place, int face);
  void addLegend(double left);

  const assembly::MeshFaces& faces_;
  std::span<const mesh::Mesh* const> meshes_;
  std::set<int> paired_;
  std::ostringstream text_;
};

/// What of it looks at the eye.
void Picture::addFace(const View& view, int face, std::vector<Patch>& patches) const {
  const mesh::Surface& surface = faces_.faces[index(face)].surface;
  std::map<std::pair<GlobalOrdinal, GlobalOrdinal>, int> uses; // of the lines between corners
  const auto lineAt = [](std::span<const GlobalOrdinal> corners, std::size_t c) {
    return std::minmax(corners[c], corners[(c + 1) % corners.size()]);
  };
  for (std::size_t f = 0; f < surface.numFacets(); ++f)
    for (std::size_t c = 0; c < surface.corners(f).size(); ++c)
      ++uses[lineAt(surface.corners(f), c)];
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    Patch patch{face, {}, {}, 0, 0};
    std::vector<Point> points;
    for (const GlobalOrdinal node : surface.facet(f))
      points.push_back(meshOf(face).point(node));
    patch.light = view.axes.row(2).dot(mesh::areaVector(surface.typeOf(f), points).normalized());
    if (patch.light <= 0)
      continue;
    const auto corners = surface.corners(f);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Vector3d x = vectorAt(meshOf(face), corners[c]);
      patch.corners.push_back(view.onPaper(x));
      patch.isRim.push_back(uses.at(lineAt(corners, c)) == 1 ? 1 : 0);
      patch.depth += view.axes.row(2).dot(x) / static_cast<double>(corners.size());
    }
    patches.push_back(std::move(patch));
  }
}

void Picture::addName(int face) {
  const assembly::Face& own = faces_.assembly.faces[index(face)];
  text_ << "<title>" << escaped(faces_.assembly.solids[index(own.solid)].name) << '/' << escaped(own.group)
        << ", face " << own.number << "</title>";
}

void Picture::draw(const Patch& patch) {
  const std::string colour =
      colourOf(faces_.faces[index(patch.face)].body, patch.light, paired_.contains(patch.face));
  std::ostringstream rims;
  rims.precision(5);
  text_ << "<path fill=\"" << colour << "\" stroke=\"" << colour << "\" stroke-width=\"0.4\" d=\"";
  for (std::size_t c = 0; c < patch.corners.size(); ++c) {
    const Vector2d &a = patch.corners[c], &b = patch.corners[(c + 1) % patch.corners.size()];
    text_ << (c == 0 ? 'M' : 'L') << a.x() << ' ' << a.y();
    if (patch.isRim[c] != 0)
      rims << 'M' << a.x() << ' ' << a.y() << 'L' << b.x() << ' ' << b.y();
  }
  text_ << "Z\">";
  addName(patch.face);
  text_ << "</path>\n";
  if (!rims.str().empty())
    text_ << "<path stroke=\"#222\" stroke-width=\"0.8\" d=\"" << rims.str() << "\"/>\n";
}

void Picture::addNumber(const Vector2d& place, int face) {
  text_ << "<text x=\"" << place.x() << "\" y=\"" << place.y() << "\">"
        << faces_.assembly.faces[index(face)].number << "</text>\n";
}

/// Where a face's largest patch is that nothing hides. \param patches  in the order in which they are drawn
void Picture::addNumbers(const std::vector<Patch>& patches) {
  std::map<int, std::pair<double, Vector2d>> best;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const double area = areaOf(patches[p]);
    const Vector2d centre = centreOf(patches[p]);
    const auto known = best.find(patches[p].face);
    if ((known != best.end() && known->second.first >= area) ||
        std::any_of(
            patches.begin() + static_cast<std::ptrdiff_t>(p) + 1, patches.end(),
            [&](const Patch& later) { return later.face != patches[p].face && isInside(later, centre); }))
      continue;
    best[patches[p].face] = {area, centre};
  }
  for (const auto& [face, place] : best)
    addNumber(place.second, face);
}

void Picture::addView(const View& view) {
  std::vector<Patch> patches;
  for (int face = 0; face < std::ssize(faces_.faces); ++face)
    addFace(view, face, patches);
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch& a, const Patch& b) { return a.depth < b.depth; });
  for (const Patch& patch : patches)
    draw(patch);
  addNumbers(patches);
}

/// Of a plane body, its elements.
void Picture::addInside(const View& view, int body) {
  const mesh::Mesh& mesh = *meshes_[index(body)];
  text_ << "<g fill=\"" << colourOf(body, 1, false) << "\" stroke=\"#fff\" stroke-width=\"0.3\">\n";
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const mesh::ElementNodes nodes(mesh, element);
    text_ << "<path d=\"";
    for (int c = 0; c < numCornersOf(nodes.type()); ++c) {
      const Vector2d place = view.onPaper(vectorAt(mesh, nodes[index(c)]));
      text_ << (c == 0 ? 'M' : 'L') << place.x() << ' ' << place.y();
    }
    text_ << "Z\"/>\n";
  }
  text_ << "</g>\n";
}

/// Of a plane body a face, and its number in the middle.
void Picture::addEdges(const View& view, int face) {
  const mesh::Surface& surface = faces_.faces[index(face)].surface;
  text_ << "<path stroke=\"" << (paired_.contains(face) ? "#c22" : "#222") << "\" stroke-width=\"1.6\" d=\"";
  for (std::size_t f = 0; f < surface.numFacets(); ++f)
    for (std::size_t c = 0; c < 2; ++c) {
      const Vector2d place = view.onPaper(vectorAt(meshOf(face), surface.corners(f)[c]));
      text_ << (c == 0 ? 'M' : 'L') << place.x() << ' ' << place.y();
    }
  text_ << "\">";
  addName(face);
  text_ << "</path>\n";
  const std::size_t middle = surface.numFacets() / 2;
  addNumber((view.onPaper(vectorAt(meshOf(face), surface.corners(middle)[0])) +
             view.onPaper(vectorAt(meshOf(face), surface.corners(middle)[1]))) /
                2,
            face);
}

void Picture::addLegend(double left) {
  const std::vector<assembly::Solid>& bodies = faces_.assembly.solids;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const double y = viewMargin + 18 * static_cast<double>(b);
    text_ << "<rect x=\"" << left << "\" y=\"" << y << "\" width=\"12\" height=\"12\" fill=\""
          << colourOf(static_cast<int>(b), 0.7, false) << "\"/><text class=\"body\" x=\"" << left + 18
          << "\" y=\"" << y + 10 << "\">" << escaped(bodies[b].name) << "</text>\n";
  }
}

std::string Picture::make() {
  const bool isPlane = dimensionOf(meshes_.front()->cellType()) == 2;
  const double left = isPlane ? viewWidth : 2 * viewWidth, legend = 220;
  text_.precision(5);
  text_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << left + legend << ' ' << viewHeight
        << "\">\n<style>text{font:11px "
           "sans-serif;text-anchor:middle;paint-order:stroke;stroke:#fff;stroke-width:3px;"
           "pointer-events:none} .body{text-anchor:start;stroke:none} "
           "path:not([fill]){fill:none} g path:not([fill]){fill:inherit}</style>\n";
  const mesh::Box box = faces_.assembly.box();
  if (isPlane) {
    View view = View::along(Vector3d::UnitX());
    view.axes = Eigen::Matrix3d::Identity();
    view.fit(box, 0);
    for (int body = 0; body < std::ssize(meshes_); ++body)
      addInside(view, body);
    for (int face = 0; face < std::ssize(faces_.faces); ++face)
      addEdges(view, face);
  } else
    for (const double side : {1.0, -1.0}) {
      View view = View::along(side * Vector3d(1, -1.3, 0.8));
      view.fit(box, side > 0 ? 0 : viewWidth);
      addView(view);
    }
  addLegend(left);
  text_ << "</svg>\n";
  return text_.str();
}

} // namespace

std::string pictureOf(const assembly::MeshFaces& faces, std::span<const mesh::Mesh* const> meshes) {
  return Picture(faces, meshes).make();
}

} // namespace epafi::drivers
