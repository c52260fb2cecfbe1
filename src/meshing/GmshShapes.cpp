#include "epafi/meshing/GmshLibrary.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

namespace epafi::meshing {
namespace {

/// "bolt M12:3" of "Shapes/flanges/bolt M12:3/bolt M12": the part comes last, its instance before it.
std::string instanceIn(std::string label) {
  if (const std::size_t part = label.rfind('/'); part != std::string::npos)
    label.resize(part);
  label.erase(0, label.rfind('/') + 1);
  const auto isDigit = [](unsigned char letter) { return std::isdigit(letter) != 0; };
  return std::all_of(label.begin(), label.end(), isDigit) ? "" : label;
}

template <class T, class Function>
std::vector<T> copied(Function fill) {
  GmshArray<T> array;
  fill(&array.data, &array.size);
  return {array.data, array.data + array.size};
}

Vector3 thirdOf(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

} // namespace

std::vector<int> GmshSession::solids() const {
  const std::vector<int> pairs =
      copied<int>([&](int** data, std::size_t* size) { call(Gmsh::get().entities, data, size, 3); });
  std::vector<int> numbers;
  for (std::size_t i = 1; i < pairs.size(); i += 2)
    numbers.push_back(pairs[i]);
  return numbers;
}

std::vector<std::string> GmshSession::solidNames() const {
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const int solid : solids()) {
    GmshArray<char> label;
    call(Gmsh::get().entityName, 3, solid, &label.data);
    std::string name = instanceIn(label.data == nullptr ? "" : label.data);
    if (name.empty() || known.contains(name))
      name += (name.empty() ? "solid " : " ") + std::to_string(solid);
    known.insert(name);
    names.push_back(name);
  }
  return names;
}

std::vector<int> GmshSession::boundaryOf(int solid, int dimension) const {
  int entity[] = {3, solid};
  constexpr int apart = 0, unsignedNumbers = 0;
  const std::vector<int> pairs = copied<int>([&](int** data, std::size_t* size) {
    call(Gmsh::get().boundary, entity, std::size_t{2}, data, size, apart, unsignedNumbers,
         static_cast<int>(dimension == 0));
  });
  std::set<int> numbers;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    numbers.insert(pairs[i + 1]);
  return {numbers.begin(), numbers.end()};
}

std::string GmshSession::kindOf(int face) const {
  GmshArray<char> type;
  call(Gmsh::get().typeOf, 2, face, &type.data);
  return type.data == nullptr ? "" : type.data;
}

Point GmshSession::placeOf(int corner) const {
  return thirdOf(copied<double>([&](double** data, std::size_t* size) {
                   call(Gmsh::get().value, 0, corner, static_cast<double*>(nullptr), std::size_t{0}, data,
                        size);
                 }),
                 0);
}

double GmshSession::measureOf(int dimension, int number) const {
  double measure = 0;
  call(Gmsh::get().measure, dimension, number, &measure);
  return measure;
}

Point GmshSession::centreOf(int face) const {
  Point centre{};
  call(Gmsh::get().centre, 2, face, &centre[0], &centre[1], &centre[2]);
  return centre;
}

mesh::Box GmshSession::boxOf(int dimension, int number) const {
  mesh::Box box;
  auto& [lower, upper] = box;
  call(Gmsh::get().box, dimension, number, &lower[0], &lower[1], &lower[2], &upper[0], &upper[1], &upper[2]);
  return box;
}

std::array<double, 4> GmshSession::boundsOf(int face) const {
  GmshArray<double> least, greatest;
  call(Gmsh::get().bounds, 2, face, &least.data, &least.size, &greatest.data, &greatest.size);
  return {least.data[0], least.data[1], greatest.data[0], greatest.data[1]};
}

std::vector<GmshSession::FacePoint> GmshSession::pointsOf(int face, std::vector<double> parameters) const {
  const Gmsh& gmsh = Gmsh::get();
  double* const uv = parameters.data();
  const std::size_t size = parameters.size();
  const auto points = copied<double>(
      [&](double** data, std::size_t* number) { call(gmsh.value, 2, face, uv, size, data, number); });
  const auto slopes = copied<double>(
      [&](double** data, std::size_t* number) { call(gmsh.derivative, 2, face, uv, size, data, number); });
  const auto normals = copied<double>(
      [&](double** data, std::size_t* number) { call(gmsh.normal, face, uv, size, data, number); });
  std::vector<FacePoint> result;
  for (std::size_t i = 0; i < size / 2; ++i) {
    const Vector3 a = thirdOf(slopes, 2 * i), b = thirdOf(slopes, 2 * i + 1);
    const double stretch =
        std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    result.push_back({thirdOf(points, i), thirdOf(normals, i), stretch});
  }
  return result;
}

bool GmshSession::isInside(int face, double u, double v) const {
  double parameters[] = {u, v};
  int error = 0;
  return Gmsh::get().isInside(2, face, parameters, 2, &error) > 0;
}

std::vector<Point> GmshSession::closestOn(int face, const std::vector<Point>& points) const {
  std::vector<double> places;
  for (const Point& point : points)
    places.insert(places.end(), point.begin(), point.end());
  GmshArray<double> unreliable; // Gmsh 4.8 says 0 of all parameters
  const auto closest = copied<double>([&](double** data, std::size_t* size) {
    call(Gmsh::get().closest, 2, face, places.data(), places.size(), data, size, &unreliable.data,
         &unreliable.size);
  });
  std::vector<Point> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    result.push_back(thirdOf(closest, i));
  return result;
}

std::optional<std::array<double, 2>> GmshSession::parametersOf(int face, Point point) const {
  const Gmsh& gmsh = Gmsh::get();
  GmshArray<double> parameters;
  int error = 0;
  gmsh.parameters(2, face, point.data(), 3, &parameters.data, &parameters.size, &error);
  if (error == 0 && parameters.size == 2 && firstGmshError().empty())
    return std::array{parameters.data[0], parameters.data[1]};
  gmsh.stopLog(&error); // it is no error of the file
  gmsh.startLog(&error);
  return std::nullopt;
}

GmshSession::Curvature GmshSession::curvatureOf(int face, double u, double v) const {
  double parameters[] = {u, v};
  GmshArray<double> greatest, least, greatestDirection, leastDirection;
  call(Gmsh::get().curvatures, face, parameters, std::size_t{2}, &greatest.data, &greatest.size, &least.data,
       &least.size, &greatestDirection.data, &greatestDirection.size, &leastDirection.data,
       &leastDirection.size);
  const double first = std::abs(greatest.data[0]), second = std::abs(least.data[0]);
  const double* const direction = first < second ? greatestDirection.data : leastDirection.data;
  return {std::max(first, second), std::min(first, second), {direction[0], direction[1], direction[2]}};
}

void GmshSession::nameShapes() const {
  const std::vector<int> numbers = solids();
  if (numbers.empty())
    throw InputError("The file \"" + file_ + "\" has no solid; only bodies that fill space can be solved");
  const std::vector<std::string> names = solidNames();
  const auto group = [&](int dimension, int number, const std::string& name) {
    int error = 0;
    const int tag = Gmsh::get().addGroup(dimension, &number, 1, -1, &error);
    check(error);
    call(Gmsh::get().nameGroup, dimension, tag, name.c_str());
  };
  for (std::size_t s = 0; s < numbers.size(); ++s) {
    group(3, numbers[s], names[s]);
    for (const int face : boundaryOf(numbers[s], 2))
      group(2, face, "face " + std::to_string(face));
    for (const int corner : boundaryOf(numbers[s], 0))
      group(0, corner, "point " + std::to_string(corner));
  }
}

/// Elements of a solid are at most 0.9 times twice its volume over its surface, the thickness of a plate.
void GmshSession::setStepSizes(const StepSizes& sizes) const {
  const Gmsh& gmsh = Gmsh::get();
  for (const int solid : solids()) {
    double area = 0;
    for (const int face : boundaryOf(solid, 2))
      area += measureOf(2, face);
    std::vector<int> corners;
    for (const int corner : boundaryOf(solid, 0))
      corners.insert(corners.end(), {0, corner});
    call(gmsh.setSize, corners.data(), corners.size(), 1.8 * measureOf(3, solid) / area);
  }
  call(gmsh.setNumber, "Mesh.MeshSizeFromCurvature", sizes.elementsAround);
  call(gmsh.setNumber, "General.NumThreads", 1);
  const auto field = [&](const char* kind) {
    int error = 0;
    const int tag = gmsh.addField(kind, -1, &error);
    check(error);
    return tag;
  };
  std::vector<double> balls;
  for (std::size_t i = 0; i + 3 < sizes.finePoints.size(); i += 4) {
    const double size = sizes.finePoints[i + 3], coarse = 100 * size, growth = 0.5;
    const int ball = field("Ball");
    const std::pair<const char*, double> values[] = {{"XCenter", sizes.finePoints[i]},
                                                     {"YCenter", sizes.finePoints[i + 1]},
                                                     {"ZCenter", sizes.finePoints[i + 2]},
                                                     {"Radius", 4 * size},
                                                     {"VIn", size},
                                                     {"VOut", coarse},
                                                     {"Thickness", (coarse - size) / growth}};
    for (const auto& [name, value] : values)
      call(gmsh.setFieldNumber, ball, name, value);
    balls.push_back(ball);
  }
  if (balls.empty())
    return;
  const int least = field("Min");
  call(gmsh.setFieldNumbers, least, "FieldsList", balls.data(), balls.size());
  call(gmsh.setBackground, least);
}

} // namespace epafi::meshing
