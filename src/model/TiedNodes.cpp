#include "epafi/model/TiedNodes.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/KnownRows.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace epafi::model {

using contact::ContactLayout;

TiedNodes::TiedNodes(std::vector<ContactLayout>& ties) : ties_(ties) {
  for (const ContactLayout& tie : ties) {
    nodes_[{tie.firstBody, tie.secondBody}].insert(tie.firstNodes.begin(), tie.firstNodes.end());
    if (!tie.firstShares.empty()) // by mortars nodes of the other side are not held one by one
      continue;
    for (const auto& shares : tie.secondNodes)
      for (const contact::NodeShare& share : shares)
        nodes_[{tie.secondBody, tie.firstBody}].insert(share.node);
  }
}

std::function<bool(GlobalOrdinal)> TiedNodes::heldBetween(int body, int other) const {
  const auto found = nodes_.find({body, other});
  if (found == nodes_.end())
    return {};
  return [&held = found->second](GlobalOrdinal node) { return held.contains(node); };
}

std::string TiedNodes::nameBetween(int body, int other) const {
  for (const ContactLayout& tie : ties_)
    if (std::minmax(tie.firstBody, tie.secondBody) == std::minmax(body, other))
      return "'" + tie.name + "'";
  return "";
}

void TiedNodes::dropFrom(ContactLayout& contact) const {
  const auto isHeld = heldBetween(contact.firstBody, contact.secondBody),
             isOtherHeld = heldBetween(contact.secondBody, contact.firstBody);
  if (!isHeld && !isOtherHeld)
    return;
  const auto isTied = [&](GlobalOrdinal own, const auto& shares) {
    return (isHeld && isHeld(own)) ||
           (isOtherHeld && std::all_of(shares.begin(), shares.end(), [&](const contact::NodeShare& share) {
              return isOtherHeld(share.node);
            }));
  };
  std::vector<std::size_t> kept;
  std::string names;
  for (std::size_t row = 0; row < contact.firstNodes.size(); ++row) {
    const GlobalOrdinal own = contact.firstNodes[row];
    const auto& shares = contact.secondNodes[row];
    const GlobalOrdinal other = shares.front().node;
    if (!isTied(own, shares)) {
      kept.push_back(row);
      continue;
    }
    for (ContactLayout& tie : ties_)
      for (std::size_t place = 0; place < tie.firstNodes.size(); ++place)
        if (tie.firstNodes[place] == (tie.firstBody == contact.firstBody ? own : other) &&
            std::minmax(tie.firstBody, tie.secondBody) ==
                std::minmax(contact.firstBody, contact.secondBody)) {
          tie.areas[place] += contact.areas[row];
          names = "'" + tie.name + "'";
        }
  }
  if (kept.empty())
    refuseTied(contact.name, nameBetween(contact.firstBody, contact.secondBody));
  const std::size_t numDropped = contact.firstNodes.size() - kept.size();
  if (numDropped == 0)
    return;
  contact::keepRows(contact, kept);
  contact.note = std::to_string(numDropped) + (numDropped == 1 ? " more node is" : " more nodes are") +
                 " tied by " + (names.empty() ? nameBetween(contact.firstBody, contact.secondBody) : names) +
                 ", whose force is that of both there";
}

void noteCircles(std::vector<ContactLayout>& ties) {
  using Node = std::pair<int, GlobalOrdinal>; // of a body
  std::map<Node, Node> next;                  // on the way to the one that stands for all that hang together
  const auto rootOf = [&](Node node) {
    for (auto found = next.find(node); found != next.end(); found = next.find(node))
      node = found->second;
    return node;
  };
  for (ContactLayout& tie : ties) {
    std::map<GlobalOrdinal, GlobalOrdinal> pairs;
    if (tie.hasOwnRows && tie.firstShares.empty())
      for (std::size_t row = 0; row < tie.firstNodes.size(); ++row)
        if (tie.secondNodes[row].size() == 1)
          pairs.emplace(tie.firstNodes[row], tie.secondNodes[row].front().node);
    int number = 0;
    for (const auto& [first, second] : pairs) {
      const Node a = rootOf({tie.firstBody, first}), b = rootOf({tie.secondBody, second});
      if (a == b)
        ++number;
      else
        next.emplace(a, b);
    }
    if (number > 0)
      tie.note = std::to_string(number) + (number == 1 ? " pair of nodes is" : " pairs of nodes are") +
                 " held together by other ties, too; how they share the force there is not unique";
  }
}

void refuseTied(const std::string& contact, const std::string& tie) {
  throw InputError("contact '" + contact + "' joins surfaces that " + tie +
                   " ties, which can neither part nor slide; remove one of them");
}

} // namespace epafi::model
