#pragma once

/// Which subdomains share a node, and what its copies tell each other.

#include "epafi/base/PointToPoint.hpp"
#include "epafi/decomposition/Substructures.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace epafi::decomposition {

/// The nodes of this rank's subdomains that several subdomains, of any rank, have. A *copy* is such a node in
/// one of this rank's subdomains; copies are numbered subdomain by subdomain, in each by ascending places.
class SharedNodes {
public:
  SharedNodes() = default;
  /// The ranks tell each other the border nodes of their subdomains; each keeps lists of its own nodes only.
  /// \throws InputError, the same on all ranks, if the subdomains at a node differ in its free unknowns.
  /// Collective.
  explicit SharedNodes(const Substructures& all);
  /// Those alone whose subdomains are all of one cluster. \param clusterOf of each subdomain of the whole
  /// problem Collective.
  SharedNodes(const Substructures& all, std::span<const int> clusterOf);

  struct Copy {
    NodePlace place;
    std::size_t node;  ///< its number among the shared nodes
    std::size_t order; ///< its place among the subdomains at the node
  };

  [[nodiscard]] std::size_t numNodes() const { return start_.size() - 1; }
  [[nodiscard]] std::size_t numCopies() const { return copies_.size(); }
  [[nodiscard]] const Copy& copy(std::size_t number) const { return copies_[number]; }
  /// Those of a subdomain, ascending places.
  [[nodiscard]] std::span<const Copy> copiesOf(SubdomainPlace subdomain) const {
    return std::span(copies_).subspan(firstCopy_[subdomain],
                                      firstCopy_[subdomain + 1] - firstCopy_[subdomain]);
  }
  /// Numbers of the subdomains at a shared node, ascending.
  [[nodiscard]] std::span<const int> subdomainsAt(std::size_t node) const {
    return std::span(numbers_).subspan(start_[node], start_[node + 1] - start_[node]);
  }
  /// The number of the copy at a place of a subdomain; nothing if no other subdomain has the node.
  [[nodiscard]] std::optional<std::size_t> find(SubdomainPlace subdomain, NodePlace place) const;
  /// Whether no lower subdomain has the node at a place.
  [[nodiscard]] bool isLowest(SubdomainPlace subdomain, NodePlace place) const;

  /// What the copies tell each other: `values` holds `columns` numbers a copy; those of all copies at this
  /// rank's shared nodes come back, in the places that `slot` tells. Only the nodes for which
  /// `isWanted(node)`, the same on all ranks, send messages. Collective.
  template <class T, class Wanted>
  [[nodiscard]] std::vector<T> exchange(std::vector<T> values, std::size_t columns, Wanted&& isWanted) const {
    values.resize((numCopies() + numGhosts_) * columns);
    std::map<int, std::vector<T>> outgoing;
    std::set<int> senders;
    for (const Neighbour& neighbour : neighbours_) {
      std::vector<T>& message = outgoing[neighbour.rank];
      senders.insert(neighbour.rank);
      for (const std::size_t copy : neighbour.sent)
        if (isWanted(copies_[copy].node))
          message.insert(message.end(), values.begin() + copy * columns,
                         values.begin() + (copy + 1) * columns);
    }
    const std::map<int, std::vector<T>> incoming = epafi::exchange(*comm_, outgoing, senders);
    for (const Neighbour& neighbour : neighbours_) {
      const T* next = incoming.at(neighbour.rank).data();
      for (const auto& [slot, node] : neighbour.received)
        if (isWanted(node))
          for (std::size_t k = 0; k < columns; ++k)
            values[slot * columns + k] = *next++;
    }
    return values;
  }
  /// Place in exchanged values, over `columns`, of a shared node's copy in the `order`-th subdomain there.
  [[nodiscard]] std::size_t slot(std::size_t node, std::size_t order) const {
    return slots_[start_[node] + order];
  }

private:
  /// Another rank, and what goes to it and comes from it, both by ascending nodes and subdomains.
  struct Neighbour {
    int rank = 0;
    std::vector<std::size_t> sent;                             ///< copies
    std::vector<std::pair<std::size_t, std::size_t>> received; ///< slots and their nodes
  };

  RCP<const Comm> comm_;
  std::vector<Copy> copies_;
  std::vector<std::size_t> firstCopy_{0};
  std::vector<std::size_t> start_{0}; ///< of each shared node in the next two
  std::vector<int> numbers_;
  std::vector<std::size_t> slots_; ///< a copy of this rank, or numCopies + a ghost
  std::size_t numGhosts_ = 0;
  std::vector<Neighbour> neighbours_;
};

} // namespace epafi::decomposition
