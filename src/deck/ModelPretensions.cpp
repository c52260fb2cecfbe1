#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>

namespace epafi::deck {
namespace {

[[noreturn]] void refuse(const Pretension& pretension, const std::string& what) {
  throw InputError(text(pretension.place) + ": *PRE-TENSION SECTION: " + what);
}

} // namespace

/// The bodies that have the faces of a section, and that lie across them, and the nodes in between.
ModelMaker::Cut ModelMaker::cutAt(const Pretension& pretension) const {
  std::set<int> own, across;
  Cut cut;
  std::map<Numbers, GlobalOrdinal> elementAt; // by corners, ascending
  const auto cornersOf = [&](GlobalOrdinal element, int label) {
    Numbers corners = bodies_.cornersOf({element, label});
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  for (const auto& [element, label] : deck_.surfaces.at(pretension.surface).faces) {
    elementAt[cornersOf(element, label)] = element;
    own.insert(bodies_.ofElement(element));
  }
  for (const DeckBody& body : bodies_.all())
    for (const GlobalOrdinal element : body.elements)
      for (int label = 1; label <= std::ssize(bodies_.typeOf(element).faces); ++label) {
        const auto found = elementAt.find(cornersOf(element, label));
        if (found == elementAt.end() || found->second == element)
          continue;
        across.insert(bodies_.ofElement(element));
        const auto theirs = bodies_.nodesOf(found->second);
        for (const GlobalOrdinal node : bodies_.nodesOf(element))
          if (std::find(theirs.begin(), theirs.end(), node) != theirs.end())
            cut.nodes.insert(node);
      }
  if (own.size() != 1 || across.size() != 1 || own == across)
    refuse(pretension, "the faces of " + pretension.surface +
                           " do not part one body into two; let the section go "
                           "through the whole shank, all faces on its one side");
  cut.first = *own.begin();
  cut.second = *across.begin();
  return cut;
}

void ModelMaker::addPretensions() {
  const Prescribed held = deck_.pretensions.empty() ? Prescribed() : prescribed();
  std::vector<std::string> preloads(deck_.steps.size());
  GlobalOrdinal lastNumber = deck_.nodes.numbers.empty() ? 0 : deck_.nodes.numbers.back();
  for (const Pretension& pretension : deck_.pretensions) {
    if (pretension.element)
      refuse(pretension, "beams are not read; model the bolt by solid elements");
    const auto& [first, second, nodes] = cuts_.emplace_back(cutAt(pretension));
    for (GlobalOrdinal& number : model_.nodeNumbers[first]) // CalculiX leaves the other side its numbers
      if (nodes.contains(number))
        number = ++lastNumber;
    model_.groups.surfaces[pretension.surface] = deck_.surfaces.at(pretension.surface).faces;
    const std::string name = "bolt " + pretension.surface;
    Teuchos::ParameterList& joint = model_.scene.sublist("Contact").sublist(name);
    joint.set("Kind", "tied");
    joint.set("First Body", bodies_.all()[first].name);
    joint.set("First Surface", pretension.surface);
    joint.set("Second Body", bodies_.all()[second].name);
    joint.set("Second Surface", pretension.surface);
    if (pretension.direction) {
      const Point& n = *pretension.direction;
      joint.set("Preload Direction",
                Teuchos::Array<double>(n.begin(), n.begin() + bodies_.all()[first].type->dimension));
    }
    const auto lengths = held.find({pretension.node, 0});
    for (std::size_t k = 0; k < preloads.size(); ++k) {
      const Hold hold = lengths == held.end() ? Hold() : lengths->second[k];
      const std::string preload = hold.isFixed  ? "locked"
                                  : hold.isHeld ? "shortening " + valueText(hold.value)
                                                : "force " + valueText(tensions_.at(pretension.node)[k]);
      if (k == 0)
        joint.set("Preload", preload);
      preloads[k] += name + " = " + preload + ", ";
    }
  }
  for (std::size_t k = 0; k < preloads.size() && preloads.size() > 1 && !deck_.pretensions.empty(); ++k)
    model_.scene.sublist("Steps").sublist("step " + std::to_string(k + 1)).set("Preload", preloads[k]);
}

} // namespace epafi::deck
