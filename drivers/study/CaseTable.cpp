#include "CaseTable.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_MathExpr.hpp>
#include <Teuchos_Parser.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace epafi::drivers {
namespace {

using Teuchos::ParameterList;
using Names = std::map<std::string, std::string>;

/// A line with those that are indented below it.
struct Line {
  std::string text;
  int number = 0;
  std::vector<Line> inner = {};
};

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

/// What stands between separators that `isSeparator` tells by their place; blanks around it do not count.
std::vector<std::string> split(const std::string& text, const std::function<bool(std::size_t)>& isSeparator) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (isSeparator(i))
      parts.emplace_back();
    else
      parts.back() += text[i];
  return parts;
}
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts = split(text, [&](std::size_t i) { return text[i] == separator; });
  for (std::string& part : parts)
    part = trimmed(part);
  return parts;
}

Line treeOf(const std::string& text) {
  Line root;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto indent = line.find_first_not_of(' ');
    if (indent == std::string::npos || line[indent] == '#')
      continue;
    Line* parent = &root;
    for (std::size_t depth = 0; depth < indent && !parent->inner.empty(); depth += 2)
      parent = &parent->inner.back();
    parent->inner.push_back({trimmed(line), number});
  }
  return root;
}

/// Without exponents and signs "+", which Teuchos's reader does not know.
std::string readable(std::string text) {
  static const std::regex plus("(^|[(<>=&] ?)\\+"), exponent("[0-9.]+e[-+]?[0-9]+");
  text = std::regex_replace(text, plus, "$1");
  for (std::smatch found; std::regex_search(text, found, exponent);) {
    std::array<char, 400> digits{};
    const auto end =
        std::to_chars(digits.begin(), digits.end(), std::stod(found.str()), std::chars_format::fixed);
    text = found.prefix().str() + std::string(digits.data(), end.ptr) + found.suffix().str();
  }
  return text;
}

double valueOf(const std::string& expression) {
  static const Teuchos::RCP<Teuchos::Reader> reader(Teuchos::MathExpr::new_calc_reader());
  if (expression == "nan" || expression == "inf")
    return std::stod(expression);
  Teuchos::any value;
  reader->read_string(value, readable(expression), expression);
  return Teuchos::any_cast<double>(value);
}

bool holds(const std::string& condition) {
  return valueOf(condition + " ? 1 : 0") == 1;
}

bool isNumber(const std::string& text) {
  return text == "nan" || text == "inf" ||
         (!text.empty() && std::string("0123456789.+-(").find(text.front()) != std::string::npos);
}

template <class Number>
Teuchos::Array<Number> arrayOf(const std::string& text) {
  Teuchos::Array<Number> array;
  for (const std::string& entry : split(text.substr(1, text.size() - 2), ','))
    array.push_back(static_cast<Number>(valueOf(entry)));
  return array;
}

Teuchos::ParameterEntry entryOf(const std::string& name, const std::string& text) {
  static const std::set<std::string> integers{"Cluster", "Elements", "Order",
                                              "Grid",    "Parts",    "Maximum Iterations"};
  const bool isInteger = integers.count(name) > 0;
  if (text.starts_with('{'))
    return isInteger ? Teuchos::ParameterEntry(arrayOf<int>(text))
                     : Teuchos::ParameterEntry(arrayOf<double>(text));
  if (!isNumber(text))
    return Teuchos::ParameterEntry(text);
  const double value = valueOf(text);
  return isInteger ? Teuchos::ParameterEntry(static_cast<int>(value)) : Teuchos::ParameterEntry(value);
}

/// Calls `work` with every list that a path leads to, without its last name.
void visit(ParameterList& list, std::vector<std::string> path,
           const std::function<void(ParameterList&, const std::string&)>& work) {
  if (path.size() == 1)
    return work(list, path.front());
  const std::string first = path.front();
  path.erase(path.begin());
  if (first != "*")
    return visit(list.sublist(first), path, work);
  std::vector<std::string> names;
  for (auto entry = list.begin(); entry != list.end(); ++entry)
    names.push_back(list.name(entry));
  for (const std::string& name : names)
    visit(list.sublist(name), path, work);
}

class Expansion {
public:
  Expansion(const std::string& text, bool quick) : root_(treeOf(text)), quick_(quick) {}

  std::vector<Case> run(const std::string& family) {
    for (const Line& line : root_.inner)
      if (line.text.starts_with("family ") && (family.empty() || line.text == "family " + family)) {
        family_ = line.text.substr(7);
        Names names;
        ParameterList nothing;
        run(line.inner, names, nothing);
      }
    return std::move(cases_);
  }

private:
  void run(const std::vector<Line>& block, Names& names, ParameterList& list) {
    for (const Line& line : block)
      try {
        run(line, names, list);
      } catch (const InputError&) {
        throw;
      } catch (const std::exception& error) {
        throw InputError("line " + std::to_string(line.number) + " of the cases, \"" + line.text +
                         "\": " + error.what());
      }
  }

  void run(const Line& line, Names& names, ParameterList& list) {
    const std::string word = line.text.substr(0, line.text.find(' '));
    const std::string rest = trimmed(line.text.substr(word.size()));
    if (word == "for") {
      loop(line, rest, names, list);
    } else if (word == "if") {
      if (holds(substituted(rest, names)))
        run(line.inner, names, list);
    } else if (word == "let") {
      const auto equals = rest.find(" =");
      names[rest.substr(0, equals)] = computed(substituted(chosen(rest.substr(equals + 2)), names));
    } else if (word == "use") {
      use(substituted(rest, names), names, list);
    } else if (word == "reference") {
      run(line.inner, names, list.sublist("Reference"));
    } else if (word == "remove") {
      visit(list, split(substituted(rest, names), '/'),
            [](ParameterList& from, const std::string& name) { from.remove(name, false); });
    } else if (word == "case") {
      std::vector<std::string> parts = split(substituted(rest, names), ';');
      parts.resize(std::max<std::size_t>(parts.size(), 3));
      cases_.push_back({family_, parts[0], parts[1]});
      if (!parts[2].empty())
        cases_.back().value = valueOf(parts[2]);
      Names inner = names;
      ParameterList own;
      run(line.inner, inner, own);
      cases_.back().list = own;
    } else {
      set(substituted(line.text, names), list);
    }
  }

  void loop(const Line& line, const std::string& rest, const Names& names, ParameterList& list) {
    const std::string heads = rest.substr(0, rest.find(' ')), tail = rest.substr(heads.size() + 1);
    std::vector<std::string> values;
    if (std::smatch range; std::regex_match(tail, range, std::regex("from (.*) to (.*?)( step (.*))?"))) {
      const double last = valueOf(substituted(range[2], names));
      const double step = range[4].matched ? valueOf(range[4]) : 1;
      for (double value = valueOf(substituted(range[1], names)); value <= last; value += step)
        values.push_back(valueText(value));
    } else {
      const std::string all = trimmed(substituted(chosen(tail.substr(2)), names));
      values = split(all, all.find(';') != std::string::npos ? ';' : ' ');
    }
    const std::vector<std::string> variables = split(heads, ',');
    for (const std::string& value : values) {
      const std::vector<std::string> parts =
          variables.size() == 1 ? std::vector{value} : split(value, [&](std::size_t i) {
            return value[i] == ',' && (i + 1 == value.size() || value[i + 1] != ' ');
          });
      if (parts.size() != variables.size())
        throw std::runtime_error("\"" + value + "\" is not a value for each of " + heads);
      Names inner = names;
      for (std::size_t i = 0; i < parts.size(); ++i)
        inner[variables[i]] = computed(parts[i]);
      run(line.inner, inner, list);
    }
  }

  void use(const std::string& call, const Names& names, ParameterList& list) {
    const auto [name, given] = nameAndParameters(call);
    for (const Line& line : root_.inner)
      if (line.text.starts_with("scene ")) {
        auto [found, parameters] = nameAndParameters(line.text.substr(6));
        if (found != name)
          continue;
        Names inner = names;
        for (const auto& some : {parameters, given})
          for (const auto& [key, value] : some)
            inner[key] = computed(value);
        return run(line.inner, inner, list);
      }
    throw std::runtime_error("there is no scene \"" + name + '"');
  }

  static void set(const std::string& text, ParameterList& list) {
    const auto equals = text.find(" = ");
    if (equals == std::string::npos)
      throw std::runtime_error("this is not understood");
    const std::string value = trimmed(text.substr(equals + 3));
    visit(list, split(text.substr(0, equals), '/'),
          [&](ParameterList& in, const std::string& name) { in.setEntry(name, entryOf(name, value)); });
  }

  /// "some name a=1 b=two words": the name, and {a, 1}, {b, two words}.
  static std::pair<std::string, Names> nameAndParameters(const std::string& text) {
    std::string name, key;
    Names parameters;
    for (const std::string& word : split(text, ' ')) {
      const auto equals = word.find('=');
      if (equals != std::string::npos)
        parameters[key = word.substr(0, equals)] = word.substr(equals + 1);
      else if (key.empty())
        name += (name.empty() ? "" : " ") + word;
      else
        parameters[key] += ' ' + word;
    }
    return {name, parameters};
  }

  static std::string computed(const std::string& text) {
    return text.starts_with('(') ? valueText(valueOf(text)) : text;
  }

  /// The quick or the full one of "QUICK | FULL".
  [[nodiscard]] std::string chosen(const std::string& text) const {
    const std::vector<std::string> both = split(text, '|');
    return both[both.size() > 1 && !quick_ ? 1 : 0];
  }

  static std::string substituted(const std::string& text, const Names& names) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] != '$') {
        result += text[i];
        continue;
      }
      std::string name;
      while (i + 1 < text.size() && std::isalnum(static_cast<unsigned char>(text[i + 1])) != 0)
        name += text[++i];
      if (names.count(name) == 0)
        throw std::runtime_error("nothing is known of $" + name);
      result += names.at(name);
    }
    return result;
  }

  Line root_;
  bool quick_;
  std::string family_;
  std::vector<Case> cases_;
};

} // namespace

ParameterList Case::scene() const {
  ParameterList result("Epafi");
  for (const char* part : {"Title", "Bodies", "Obstacles", "Contact", "Decomposition"})
    if (const Teuchos::ParameterEntry* entry = list.getEntryPtr(part); entry != nullptr)
      result.setEntry(part, *entry);
  return result;
}

std::vector<Case> expandCases(const std::string& text, const std::string& family, bool quick) {
  return Expansion(text, quick).run(family);
}

} // namespace epafi::drivers
