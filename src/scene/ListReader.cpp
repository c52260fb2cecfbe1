#include "epafi/scene/ListReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"

#include <Teuchos_Array.hpp>

#include <cmath>

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

Edge ListReader::edge(const std::string& name) const {
  for (const Edge edge : {Edge::left, Edge::right, Edge::bottom, Edge::top})
    if (toString(edge) == word(name))
      return edge;
  refuseValue(name, "must be one of \"left\", \"right\", \"bottom\", \"top\"");
}

Rectangle ListReader::rectangle(const std::string& name) const {
  const auto& values = list_.get<Teuchos::Array<double>>(name);
  if (values.size() != 4)
    refuseValue(name, "must have 4 entries {x0, x1, y0, y1}, not " + std::to_string(values.size()));
  for (const double value : values)
    if (value != 0 && !isModerate(value))
      refuseValue(name, "its entries must be 0 or " + moderateMagnitude);
  const Rectangle box{values[0], values[1], values[2], values[3]};
  if (!(box.x0 < box.x1) || !(box.y0 < box.y1))
    refuseValue(name, "must have a positive size, x0 < x1 and y0 < y1 in {x0, x1, y0, y1}");
  if (!isModerate(box.x1 - box.x0) || !isModerate(box.y1 - box.y0))
    refuseValue(name, "its sides must be " + moderateMagnitude);
  return box;
}

std::array<int, 2> ListReader::counts(const std::string& name) const {
  const auto& values = list_.get<Teuchos::Array<int>>(name);
  if (values.size() != 2)
    refuseValue(name, "must have 2 entries {nx, ny}, not " + std::to_string(values.size()));
  if (values[0] < 1 || values[1] < 1)
    refuseValue(name, "must have entries of at least 1");
  return {values[0], values[1]};
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
