#include "epafi/contact/KnownRows.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>
#include <utility>

namespace epafi::contact {
namespace {

/// Directions, and gaps beside the nodes' spacing, that agree to this are the same.
constexpr double same = 1e-9;

} // namespace

void keepRows(ContactLayout& contact, const std::vector<std::size_t>& places) {
  const std::size_t components = contact.numComponents();
  const auto keep = [&](auto& values, std::size_t perRow) {
    if (values.empty())
      return;
    std::remove_reference_t<decltype(values)> kept;
    for (const std::size_t place : places)
      for (std::size_t c = 0; c < perRow; ++c)
        kept.push_back(values[place * perRow + c]);
    values = std::move(kept);
  };
  keep(contact.directions, components);
  keep(contact.firstNodes, 1);
  keep(contact.firstShares, 1);
  keep(contact.secondNodes, 1);
  keep(contact.symmetryPlanes, 1);
  keep(contact.gaps, 1);
  keep(contact.areas, 1);
  for (std::vector<double>& areas : contact.areasOfParts)
    keep(areas, 1);
}

KnownRows::Entry KnownRows::entryOf(const ContactLayout& contact, std::size_t place) {
  Place from{contact.firstBody, contact.firstNodes[place]},
      to{contact.secondBody, contact.secondBody < 0 ? 0 : contact.secondNodes[place].front().node};
  Row row{contact.name, contact.number, 0, contact.directionAt(place), contact.gaps[place], 0};
  if (contact.secondBody >= 0 && to < from) { // the same row, seen from the other side
    std::swap(from, to);
    row.direction = -row.direction;
  }
  return {{from, to}, row};
}

/// Rows of one place in opposite directions leave a slot between them, which must not be narrower than
/// nothing.
void KnownRows::requireRoom(const Entry& entry, Iterator first, Iterator last) {
  for (auto other = first; other != last; ++other) {
    const double slot = entry.second.gap + other->second.gap;
    if ((other->second.direction + entry.second.direction).norm() > same ||
        slot >= -same * entry.second.spacing)
      continue;
    std::ostringstream overlap;
    overlap << -slot;
    throw SolvabilityError(SolvabilityError::Kind::noSolution,
                           "no solution: the contacts '" + other->second.contact + "' and '" +
                               entry.second.contact +
                               "' push the same node from opposite sides, which overlap by " + overlap.str() +
                               "; move an obstacle or change the surfaces");
  }
}

std::vector<KnownRows::Dropped> KnownRows::dropFrom(ContactLayout& contact, double spacing) {
  std::vector<Dropped> dropped;
  std::vector<std::size_t> kept;
  std::vector<Entry> added;
  std::string repeated;
  for (std::size_t place = 0; place < contact.firstNodes.size(); ++place) {
    Entry entry = entryOf(contact, place);
    entry.second.spacing = spacing;
    const auto [first, last] = rows_.equal_range(entry.first);
    const auto known = std::find_if(first, last, [&](const auto& other) {
      return (other.second.direction - entry.second.direction).norm() <= same &&
             std::abs(other.second.gap - entry.second.gap) <= same * entry.second.spacing;
    });
    requireRoom(entry, first, last);
    if (known != last) {
      repeated = known->second.contact;
      dropped.push_back({known->second.number, known->second.place, contact.areas[place]});
      continue;
    }
    entry.second.place = kept.size();
    kept.push_back(place);
    added.push_back(std::move(entry));
  }
  if (kept.empty())
    throw InputError("contact '" + contact.name + "' says nothing that contact '" + repeated +
                     "' does not say: the same nodes, directions and gaps; remove one of them");
  rows_.insert(added.begin(), added.end());
  if (kept.size() < contact.firstNodes.size())
    keepRows(contact, kept);
  return dropped;
}

} // namespace epafi::contact
