#include "epafi/scene/ListReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace epafi::scene {
namespace {

/// Squares of energies and forces made of such numbers neither underflow nor overflow.
bool isModerate(double value) {
  return std::abs(value) >= 1e-30 && std::abs(value) <= 1e30;
}

const std::string moderateMagnitude = "between 1e-30 and 1e30 in magnitude; choose other units";

} // namespace

ListReader ListReader::inside(const std::string& name) const {
  return {list_.sublist(name), file_, path_.empty() ? name : path_ + '/' + name};
}

std::vector<std::string> ListReader::names() const {
  std::vector<std::string> names;
  for (auto entry = list_.begin(); entry != list_.end(); ++entry)
    names.push_back(list_.name(entry));
  return names;
}

bool ListReader::hasEntries(const std::string& name) const {
  const std::string value = valueText(list_.getEntry(name));
  return has(name) && value != "\"\"" && value != "{}";
}

double ListReader::real(const std::string& name) const {
  const auto value = list_.get<double>(name);
  if (value != 0 && !isModerate(value))
    refuseValue(name, "must be 0 or " + moderateMagnitude);
  return value;
}

double ListReader::positive(const std::string& name) const {
  const auto value = list_.get<double>(name);
  if (!isModerate(value))
    refuseValue(name, "must be " + moderateMagnitude);
  return value;
}

const std::string& ListReader::edge(const std::string& name) const {
  if (std::find(edges.begin(), edges.end(), word(name)) == edges.end())
    refuseValue(name, "must be one of \"left\", \"right\", \"bottom\", \"top\"");
  return word(name);
}

mesh::Box ListReader::box(const std::string& name, int dimension) const {
  const std::string form = dimension == 3 ? "{x0, x1, y0, y1, z0, z1}" : "{x0, x1, y0, y1}";
  const auto& values = list_.get<Teuchos::Array<double>>(name);
  requireLength(name, 2 * dimension, form);
  requireModerate(name);
  mesh::Box box;
  for (int d = 0; d < dimension; ++d) {
    const double lower = values[2 * d], upper = values[2 * d + 1];
    if (!(lower < upper))
      refuseValue(name, std::string("must have a positive size, x0 < x1") +
                            (dimension == 3 ? ", y0 < y1 and z0 < z1 in " : " and y0 < y1 in ") + form);
    if (!isModerate(upper - lower))
      refuseValue(name, "its sides must be " + moderateMagnitude);
    box.lower[d] = lower;
    box.upper[d] = upper;
  }
  return box;
}

std::array<int, 3> ListReader::counts(const std::string& name, int dimension) const {
  const auto& values = list_.get<Teuchos::Array<int>>(name);
  requireLength(name, dimension, dimension == 3 ? "{nx, ny, nz}" : "{nx, ny}");
  std::array<int, 3> counts{1, 1, 1};
  std::copy(values.begin(), values.end(), counts.begin());
  if (*std::min_element(counts.begin(), counts.end()) < 1)
    refuseValue(name, "must have entries of at least 1");
  return counts;
}

Vector3 ListReader::vector(const std::string& name, int dimension) const {
  const auto& values = list_.get<Teuchos::Array<double>>(name);
  requireLength(name, dimension, dimension == 3 ? "{x, y, z}" : "{x, y}");
  requireModerate(name);
  Vector3 vector{0, 0, 0};
  std::copy(values.begin(), values.end(), vector.begin());
  return vector;
}

std::array<Vector3, 2> ListReader::vectors(const std::string& name) const {
  const auto& values = list_.get<Teuchos::Array<double>>(name);
  requireLength(name, 6, "{x, y, z, x, y, z}");
  requireModerate(name);
  return {{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}}};
}

std::vector<double> ListReader::reals(const std::string& name) const {
  requireModerate(name);
  const auto& values = list_.get<Teuchos::Array<double>>(name);
  return {values.begin(), values.end()};
}

int ListReader::length(const std::string& name) const {
  const Teuchos::ParameterEntry& entry = list_.getEntry(name);
  return static_cast<int>(entry.isType<Teuchos::Array<int>>()
                              ? Teuchos::getValue<Teuchos::Array<int>>(entry).size()
                              : Teuchos::getValue<Teuchos::Array<double>>(entry).size());
}

std::string ListReader::file(const std::string& name) const {
  return (std::filesystem::path(file_).parent_path() / word(name)).string();
}

void ListReader::require(const std::string& name, const std::string& needs) const {
  if (!hasEntries(name))
    refuseList("lacks its parameter \"" + name + "\" of type " + typeName(list_.getEntry(name)) +
               ", which must be given" + needs);
}

void ListReader::refuseGiven(std::initializer_list<const char*> names, const std::string& reason) const {
  for (const char* const name : names)
    if (hasEntries(name))
      refuseValue(name, reason);
}

void ListReader::requireLength(const std::string& name, int expected, const std::string& form) const {
  if (length(name) != expected)
    refuseValue(name, "must have " + std::to_string(expected) + " entries " + form + ", not " +
                          std::to_string(length(name)));
}

void ListReader::requireModerate(const std::string& name) const {
  for (const double value : list_.get<Teuchos::Array<double>>(name))
    if (value != 0 && !isModerate(value))
      refuseValue(name, "its entries must be 0 or " + moderateMagnitude);
}

void ListReader::refuseValue(const std::string& name, const std::string& objection) const {
  throw InputError((file_.empty() ? "" : file_ + ": ") +
                   asSentence("parameter \"" + name + "\" in list \"" + path_ + "\" is " +
                              valueText(list_.getEntry(name)) + ", but " + objection));
}

void ListReader::refuseList(const std::string& objection) const {
  throw InputError((file_.empty() ? "" : file_ + ": ") + asSentence("list \"" + path_ + "\" " + objection));
}

} // namespace epafi::scene
