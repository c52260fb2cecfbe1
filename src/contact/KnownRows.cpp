#include "epafi/contact/KnownRows.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace epafi::contact {
namespace {

/// Directions, and gaps beside the nodes' spacing, that agree to this are the same.
constexpr double same = 1e-9;

/// The rows of a contact at some places.
ContactLayout selected(const ContactLayout& contact, const std::vector<std::size_t>& places) {
  const std::size_t components = contact.directions.size() / contact.firstNodes.size();
  ContactLayout result = contact;
  result.firstNodes.clear();
  result.firstShares.clear();
  result.secondNodes.clear();
  result.directions.clear();
  result.gaps.clear();
  result.areas.clear();
  for (const std::size_t place : places) {
    result.firstNodes.push_back(contact.firstNodes[place]);
    if (!contact.firstShares.empty())
      result.firstShares.push_back(contact.firstShares[place]);
    if (!contact.secondNodes.empty())
      result.secondNodes.push_back(contact.secondNodes[place]);
    for (std::size_t c = 0; c < components; ++c)
      result.directions.push_back(contact.directions[place * components + c]);
    result.gaps.push_back(contact.gaps[place]);
    result.areas.push_back(contact.areas[place]);
  }
  return result;
}

} // namespace

KnownRows::Entry KnownRows::entryOf(const ContactLayout& contact, std::size_t place) {
  const std::size_t components = contact.directions.size() / contact.firstNodes.size();
  Place from{contact.firstBody, contact.firstNodes[place]},
      to{contact.secondBody, contact.secondBody < 0 ? 0 : contact.secondNodes[place].front().node};
  Row row{contact.name, {0, 0, 0}, contact.gaps[place], contact.areas[place]};
  for (std::size_t c = 0; c < components; ++c)
    row.direction[static_cast<Eigen::Index>(c)] = contact.directions[place * components + c];
  if (components == 3)
    row.spacing = std::sqrt(row.spacing);
  if (contact.secondBody >= 0 && to < from) { // the same row, seen from the other side
    std::swap(from, to);
    row.direction = -row.direction;
  }
  return {{from, to}, row};
}

/// Rows of one place in opposite directions leave a slot between them, which must not be narrower than nothing.
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

void KnownRows::dropFrom(ContactLayout& contact) {
  std::vector<std::size_t> kept;
  std::vector<Entry> added;
  std::string repeated;
  for (std::size_t place = 0; place < contact.firstNodes.size(); ++place) {
    Entry entry = entryOf(contact, place);
    const auto [first, last] = rows_.equal_range(entry.first);
    const auto known = std::find_if(first, last, [&](const auto& other) {
      return (other.second.direction - entry.second.direction).norm() <= same &&
             std::abs(other.second.gap - entry.second.gap) <= same * entry.second.spacing;
    });
    requireRoom(entry, first, last);
    if (known != last) {
      repeated = known->second.contact;
      continue;
    }
    kept.push_back(place);
    added.push_back(std::move(entry));
  }
  if (kept.empty())
    throw InputError("contact '" + contact.name + "' says nothing that contact '" + repeated +
                     "' does not say: the same nodes, directions and gaps; remove one of them");
  rows_.insert(added.begin(), added.end());
  if (kept.size() < contact.firstNodes.size())
    contact = selected(contact, kept);
}

} // namespace epafi::contact
