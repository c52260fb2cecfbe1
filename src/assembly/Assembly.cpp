#include "epafi/assembly/Assembly.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace epafi::assembly {
namespace {

/// Writes values, a line each.
struct Writer {
  std::ostringstream stream;

  template <class T>
  void operator()(T& value) {
    stream << std::setprecision(17) << value << '\n';
  }
  template <class T>
  void count(std::vector<T>& values) {
    stream << values.size() << '\n';
  }
};

/// Reads them in the same order.
struct Reader {
  std::istringstream stream;

  template <class T>
  void operator()(T& value) {
    stream >> value >> std::ws;
  }
  void operator()(std::string& value) { std::getline(stream, value); }
  template <class T>
  void count(std::vector<T>& values) {
    std::size_t number = 0;
    (*this)(number);
    values.resize(number);
  }
};

template <class Archive>
void visit(Archive& archive, std::array<double, 3>& point) {
  for (double& coordinate : point)
    archive(coordinate);
}

template <class Archive>
void visit(Archive& archive, Solid& solid) {
  archive(solid.name);
  archive(solid.volume);
  visit(archive, solid.box.lower);
  visit(archive, solid.box.upper);
}

template <class Archive>
void visit(Archive& archive, Face& face) {
  archive(face.number);
  archive(face.solid);
  archive(face.kind);
  archive(face.area);
  visit(archive, face.centre);
  visit(archive, face.axis);
  visit(archive, face.onAxis);
  archive(face.radius);
  archive(face.group);
}

template <class Archive>
void visit(Archive& archive, Corner& corner) {
  archive(corner.number);
  archive(corner.solid);
  visit(archive, corner.place);
}

template <class Archive>
void visit(Archive& archive, FacePair& pair) {
  archive(pair.first);
  archive(pair.second);
  archive(pair.area);
  archive(pair.leastGap);
  archive(pair.largestGap);
  visit(archive, pair.closest);
  archive(pair.sag);
}

template <class Archive, class T>
void visit(Archive& archive, std::vector<T>& values) {
  archive.count(values);
  for (T& value : values)
    visit(archive, value);
}

template <class Archive>
void visit(Archive& archive, Assembly& assembly) {
  archive(assembly.unit);
  visit(archive, assembly.solids);
  visit(archive, assembly.faces);
  visit(archive, assembly.corners);
  visit(archive, assembly.pairs);
  visit(archive, assembly.nearMisses);
}

} // namespace

mesh::Box Assembly::box() const {
  mesh::Box all = solids.front().box;
  for (const Solid& solid : solids)
    for (std::size_t d = 0; d < 3; ++d) {
      all.lower[d] = std::min(all.lower[d], solid.box.lower[d]);
      all.upper[d] = std::max(all.upper[d], solid.box.upper[d]);
    }
  return all;
}

double Assembly::diagonal() const {
  const auto [lower, upper] = box();
  return std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
}

std::string textOf(const Assembly& assembly) {
  Assembly copy = assembly; // the same function reads and writes
  Writer writer;
  visit(writer, copy);
  return writer.stream.str();
}

Assembly assemblyFrom(const std::string& text) {
  Reader reader{std::istringstream(text)};
  Assembly assembly;
  visit(reader, assembly);
  return assembly;
}

} // namespace epafi::assembly
