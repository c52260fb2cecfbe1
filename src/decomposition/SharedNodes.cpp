#include "epafi/decomposition/SharedNodes.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Records.hpp"

#include <Teuchos_Comm.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

/// A subdomain that has a node.
struct Sighting {
  NodeNumber node;
  SubdomainNumber number;
  int rank;
  unsigned free; ///< which components are unknowns, as the digits of a binary number

  [[nodiscard]] bool operator<(const Sighting& other) const {
    return node != other.node ? node < other.node : number < other.number;
  }
};

/// Runs of sightings of one node.
template <class Action>
void forEachNode(std::span<const Sighting> sightings, Action&& action) {
  for (std::size_t first = 0, end = 0; first < sightings.size(); first = end) {
    while (end < sightings.size() && sightings[end].node == sightings[first].node)
      ++end;
    action(sightings.subspan(first, end - first));
  }
}

unsigned freeComponents(const Substructures& all, SubdomainPlace s, NodePlace node) {
  unsigned digits = 0;
  for (const int unknown : all.unknownsAt(s, node))
    digits = 2 * digits + (unknown >= 0 ? 1 : 0);
  return digits;
}

/// The border nodes of this rank's subdomains.
std::vector<Sighting> sightingsHere(const Substructures& all) {
  std::vector<Sighting> sightings;
  for (std::size_t s = 0; s < all.size(); ++s)
    for (const int place : all.nodal[s].borderNodes) {
      const std::size_t node = place;
      sightings.push_back({all.globalNode(s, node), all.subdomains[s].number, all.comm->getRank(),
                           freeComponents(all, s, node)});
    }
  std::sort(sightings.begin(), sightings.end());
  return sightings;
}

/// A node that another rank has too.
struct Encounter {
  NodeNumber node;
  int rank;
};

/// The nodes of `here` that other ranks have, with each of these, ascending: each node has a rank, its number
/// modulo the number of ranks, that hears who has it and tells them of each other. Collective.
std::vector<Encounter> encounters(const RCP<const Comm>& comm, std::span<const Sighting> here) {
  std::vector<Encounter> mine;
  std::vector<int> ranks;
  forEachNode(here, [&](std::span<const Sighting> atNode) {
    mine.push_back({atNode.front().node, comm->getRank()});
    ranks.push_back(static_cast<int>(atNode.front().node % comm->getSize()));
  });
  const auto isLess = [](const Encounter& a, const Encounter& b) {
    return a.node != b.node ? a.node < b.node : a.rank < b.rank;
  };
  std::vector<Encounter> heard = sendRecords<Encounter>(comm, mine, ranks), told;
  std::sort(heard.begin(), heard.end(), isLess);
  ranks.clear();
  for (auto first = heard.begin(), end = first; first != heard.end(); first = end) {
    end = std::find_if(first, heard.end(), [&](const Encounter& other) { return other.node != first->node; });
    for (auto listener = first; listener != end; ++listener)
      for (auto other = first; other != end; ++other)
        if (other != listener) {
          told.push_back(*other);
          ranks.push_back(listener->rank);
        }
  }
  std::vector<Encounter> result = sendRecords<Encounter>(comm, told, ranks);
  std::sort(result.begin(), result.end(), isLess);
  return result;
}

/// All ranks' sightings, ascending, of the nodes that this rank has and several subdomains see. Collective.
std::vector<Sighting> ofSharedNodes(const RCP<const Comm>& comm, std::span<const Sighting> here) {
  std::vector<Sighting> ours, sent;
  std::vector<int> ranks;
  const std::vector<Encounter> others =
      comm->getSize() == 1 ? std::vector<Encounter>() : encounters(comm, here);
  auto other = others.begin();
  forEachNode(here, [&](std::span<const Sighting> atNode) {
    const bool isElsewhere = other != others.end() && other->node == atNode.front().node;
    for (; other != others.end() && other->node == atNode.front().node; ++other) {
      sent.insert(sent.end(), atNode.begin(), atNode.end());
      ranks.insert(ranks.end(), atNode.size(), other->rank);
    }
    if (isElsewhere || atNode.size() > 1)
      ours.insert(ours.end(), atNode.begin(), atNode.end());
  });
  if (comm->getSize() == 1)
    return ours;
  std::vector<Sighting> theirs = sendRecords<Sighting>(comm, sent, ranks), all;
  std::sort(theirs.begin(), theirs.end());
  all.reserve(ours.size() + theirs.size());
  std::merge(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(all));
  return all;
}

/// Those of nodes whose subdomains are all of one cluster.
std::vector<Sighting> insideClusters(std::span<const Sighting> shared, std::span<const int> clusterOf) {
  std::vector<Sighting> inside;
  forEachNode(shared, [&](std::span<const Sighting> atNode) {
    const auto cluster = [&](const Sighting& sighting) { return clusterOf[sighting.number]; };
    if (std::all_of(atNode.begin(), atNode.end(),
                    [&](const Sighting& sighting) { return cluster(sighting) == cluster(atNode.front()); }))
      inside.insert(inside.end(), atNode.begin(), atNode.end());
  });
  return inside;
}

void requireEqualUnknowns(const Comm& comm, std::span<const Sighting> shared) {
  collectively(comm, [&] {
    forEachNode(shared, [](std::span<const Sighting> atNode) {
      for (const Sighting& sighting : atNode)
        if (sighting.free != atNode.front().free)
          throw InputError(
              "the subdomains at node " + std::to_string(sighting.node) + ", among them " +
              std::to_string(atNode.front().number) + " and " + std::to_string(sighting.number) +
              ", do not have the same free unknowns there; an unknown that is left out or prescribed in one "
              "must be so in all that share it.");
    });
  });
}

} // namespace

SharedNodes::SharedNodes(const Substructures& all) : SharedNodes(all, {}) {}

SharedNodes::SharedNodes(const Substructures& all, std::span<const int> clusterOf) : comm_(all.comm) {
  std::vector<Sighting> shared = ofSharedNodes(comm_, sightingsHere(all));
  requireEqualUnknowns(*comm_, shared);
  if (!clusterOf.empty())
    shared = insideClusters(shared, clusterOf);

  const int me = comm_->getRank(), firstNumber = all.size() > 0 ? int{all.subdomains.front().number} : 0;
  firstCopy_.assign(all.size() + 1, 0);
  for (const Sighting& sighting : shared)
    if (sighting.rank == me)
      ++firstCopy_[sighting.number - firstNumber + 1];
  for (std::size_t s = 0; s < all.size(); ++s)
    firstCopy_[s + 1] += firstCopy_[s];
  copies_.resize(firstCopy_.back());
  numbers_.reserve(shared.size());
  slots_.reserve(shared.size());
  std::vector<std::size_t> next(firstCopy_.begin(), firstCopy_.end() - 1); // copy of each subdomain
  std::vector<std::size_t> border(all.size(), 0); // node of each subdomain to look at
  std::map<int, Neighbour> neighbours;
  forEachNode(shared, [&](std::span<const Sighting> atNode) {
    const std::size_t node = start_.size() - 1;
    for (const Sighting& sighting : atNode) {
      numbers_.push_back(sighting.number);
      if (sighting.rank != me) {
        slots_.push_back(copies_.size() + numGhosts_++);
        neighbours[sighting.rank].received.emplace_back(slots_.back(), node);
        continue;
      }
      const std::size_t s = sighting.number - firstNumber;
      const std::vector<int>& candidates = all.nodal[s].borderNodes;
      while (all.globalNode(s, candidates[border[s]]) != sighting.node)
        ++border[s];
      slots_.push_back(next[s]);
      copies_[next[s]++] = {static_cast<std::size_t>(candidates[border[s]]), node,
                            slots_.size() - 1 - start_.back()};
    }
    for (std::size_t k = start_.back(); k < slots_.size(); ++k)
      if (slots_[k] < copies_.size()) {
        int last = me;
        for (const Sighting& other : atNode)
          if (other.rank != me && std::exchange(last, other.rank) != other.rank)
            neighbours[other.rank].sent.push_back(slots_[k]);
      }
    start_.push_back(slots_.size());
  });
  for (auto& [rank, neighbour] : neighbours) {
    neighbour.rank = rank;
    neighbours_.push_back(std::move(neighbour));
  }
}

std::optional<std::size_t> SharedNodes::find(SubdomainPlace subdomain, NodePlace place) const {
  const std::span<const Copy> copies = copiesOf(subdomain);
  const auto found =
      std::lower_bound(copies.begin(), copies.end(), place,
                       [](const Copy& copy, std::size_t wanted) { return copy.place < wanted; });
  if (found == copies.end() || found->place != place)
    return std::nullopt;
  return firstCopy_[subdomain] + (found - copies.begin());
}

bool SharedNodes::isLowest(SubdomainPlace subdomain, NodePlace place) const {
  const std::optional<std::size_t> copy = find(subdomain, place);
  return !copy || copies_[*copy].order == 0;
}

} // namespace epafi::decomposition
