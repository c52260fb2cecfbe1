#pragma once

/// Contact rows that two contacts of a scene would both bring.

#include "epafi/contact/ContactLayout.hpp"

#include <Eigen/Core>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace epafi::contact {

/// Leaves out all rows of a contact but those at some places, ascending. Precondition: rows are not combined
/// (QuadraticFaces.hpp).
void keepRows(ContactLayout& contact, const std::vector<std::size_t>& places);

/// Remembers the rows of contacts. Two that hold the same nodes apart in the same direction by the same gap
/// would share one force in any proportion: the second one is left out, so that forces and active nodes are
/// counted once. Its area counts with the row that stays. Rows that differ all stay, also several at one
/// node.
class KnownRows {
public:
  /// A row that is left out.
  struct Dropped {
    int contact;       ///< number of the earlier one
    GlobalOrdinal row; ///< place there
    double area;
  };
  /// Leaves out the rows that earlier contacts have, which it returns, and keeps the others in mind. \throws
  /// InputError if none is left, SolvabilityError (no solution) if rows of two contacts at the same node
  /// oppose each other without room between them.
  /// \param spacing  of its nodes, beside which gaps agree or do not
  std::vector<Dropped> dropFrom(ContactLayout& contact, double spacing);

private:
  using Place = std::pair<int, GlobalOrdinal>; ///< body (−1: an obstacle) and node
  struct Row {
    std::string contact;
    int number;
    GlobalOrdinal place;       ///< among the contact's rows
    Eigen::Vector3d direction; ///< from the lower to the higher place
    double gap;
    double spacing; ///< of nodes
  };

  using Entry = std::pair<std::pair<Place, Place>, Row>;

  using Iterator = std::multimap<std::pair<Place, Place>, Row>::const_iterator;

  static void requireRoom(const Entry& entry, Iterator first, Iterator last);
  static Entry entryOf(const ContactLayout& contact, std::size_t place);

  std::multimap<std::pair<Place, Place>, Row> rows_;
};

} // namespace epafi::contact
