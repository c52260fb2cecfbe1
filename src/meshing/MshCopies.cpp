#include "epafi/meshing/MshCopies.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>

namespace epafi::meshing {
namespace {

/// An element, and a number that is the same for elements with the same nodes.
struct Place {
  std::uint64_t key;
  std::uint32_t block, element;
  auto operator<=>(const Place&) const = default;
};

std::span<const GlobalOrdinal> nodesOf(const MshBlock& block, std::size_t element) {
  const std::size_t count = numNodesOfGmsh(block.block.type);
  return std::span(block.nodes).subspan(element * count, count);
}

std::vector<Place> sortedPlaces(const std::vector<MshBlock>& blocks) {
  std::vector<Place> places;
  for (std::uint32_t b = 0; b < blocks.size(); ++b)
    for (std::uint32_t e = 0; e < blocks[b].block.tags.size(); ++e) {
      std::uint64_t key = 0;
      for (const GlobalOrdinal node : nodesOf(blocks[b], e)) { // in any order
        std::uint64_t mixed = node * 0x9E3779B97F4A7C15U;
        mixed = (mixed ^ (mixed >> 31U)) * 0xBF58476D1CE4E5B9U;
        key += mixed ^ (mixed >> 29U);
      }
      places.push_back({key, b, e});
    }
  std::sort(places.begin(), places.end());
  return places;
}

bool areCopies(const std::vector<MshBlock>& blocks, const Place& a, const Place& b) {
  const auto own = nodesOf(blocks[a.block], a.element), other = nodesOf(blocks[b.block], b.element);
  return a.key == b.key && a.block != b.block && blocks[a.block].block.type == blocks[b.block].block.type &&
         std::is_permutation(own.begin(), own.end(), other.begin());
}

void append(MshBlock& block, const MshBlock& from, std::size_t element) {
  const auto nodes = nodesOf(from, element);
  block.block.tags.push_back(from.block.tags[element]);
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
}

} // namespace

void joinCopies(std::vector<MshBlock>& blocks, std::map<int, std::vector<int>>& groupEntities,
                int& numEntities) {
  const std::vector<Place> places = sortedPlaces(blocks);
  std::vector<std::set<std::uint32_t>> taken(blocks.size()); // elements that others stand for
  std::map<std::vector<std::uint32_t>, MshBlock> joint;      // by the blocks that its elements were in
  for (std::size_t i = 0; i + 1 < places.size();) {
    std::size_t end = i + 1;
    while (end < places.size() && areCopies(blocks, places[end - 1], places[end]))
      ++end;
    std::vector<std::uint32_t> sources;
    for (std::size_t k = i; end - i > 1 && k < end; ++k) {
      sources.push_back(places[k].block);
      taken[places[k].block].insert(places[k].element);
    }
    if (!sources.empty()) {
      const MshBlock& first = blocks[sources.front()];
      MshBlock& block = joint.try_emplace(sources, MshBlock{{0, first.block.type, {}, {}}, {}}).first->second;
      append(block, first, places[i].element);
    }
    i = end;
  }
  if (joint.empty())
    return;
  std::vector<MshBlock> left;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    MshBlock rest{{blocks[b].block.entity, blocks[b].block.type, {}, {}}, {}};
    for (std::uint32_t e = 0; e < blocks[b].block.tags.size(); ++e)
      if (!taken[b].contains(e))
        append(rest, blocks[b], e);
    if (!rest.block.tags.empty())
      left.push_back(std::move(rest));
  }
  for (auto& [sources, block] : joint) {
    block.block.entity = ++numEntities;
    for (auto& [group, entities] : groupEntities)
      if (std::any_of(sources.begin(), sources.end(), [&](std::uint32_t source) {
            return std::find(entities.begin(), entities.end(), blocks[source].block.entity) != entities.end();
          }))
        entities.push_back(numEntities);
    left.push_back(std::move(block));
  }
  blocks = std::move(left);
}

} // namespace epafi::meshing
