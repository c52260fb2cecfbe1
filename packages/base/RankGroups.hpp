#pragma once

/// Few ranks that do something for the others.

#include "epafi/base/Types.hpp"

namespace epafi {

/// Consecutive ranks in groups as large as each other, or larger by one. The first rank of a group *leads*
/// it.
class RankGroups {
public:
  /// \param number  of the groups, from one to as many as ranks, each of which then leads itself. Collective.
  RankGroups(const RCP<const Comm>& comm, int number);

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] const RCP<const Comm>& group() const { return group_; } ///< of this rank; its rank 0 leads
  [[nodiscard]] bool leads() const;                                     ///< whether this rank does
  /// All that lead, ascending; null where this rank does not.
  [[nodiscard]] const RCP<const Comm>& leaders() const { return leaders_; }

private:
  int number_;
  RCP<const Comm> group_, leaders_;
};

} // namespace epafi
