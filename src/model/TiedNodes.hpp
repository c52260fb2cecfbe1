#pragma once

/// Nodes of contacts that tied joints between the same bodies hold already.

#include "epafi/contact/ContactLayout.hpp"

#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace epafi::model {

/// Of all tied joints; keeps a reference to them.
class TiedNodes {
public:
  explicit TiedNodes(std::vector<contact::ContactLayout>& ties);

  /// Whether a tie holds a node of a body to another one; empty if there is none between both.
  [[nodiscard]] std::function<bool(GlobalOrdinal)> heldBetween(int body, int other) const;
  /// A tie between two bodies, in quotes.
  [[nodiscard]] std::string nameBetween(int body, int other) const;
  /// Leaves out the rows of a contact by pairs of nodes that ties hold; their forces and areas are those of
  /// the ties' rows there.
  /// \throws InputError if none is left.
  void dropFrom(contact::ContactLayout& contact) const;

private:
  std::vector<contact::ContactLayout>& ties_;
  std::map<std::pair<int, int>, std::set<GlobalOrdinal>> nodes_; ///< of a body that hang on another one
};

/// Notes in ties by pairs of nodes where other ties hold the same nodes together already: how they share the
/// force there is not unique.
void noteCircles(std::vector<contact::ContactLayout>& ties);

/// Refuses a contact all of whose nodes are tied.
[[noreturn]] void refuseTied(const std::string& contact, const std::string& tie);

} // namespace epafi::model
