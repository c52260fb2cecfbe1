#pragma once

/// Elements that a mesh file of format 2.2 lists once for each of their physical groups.

#include "epafi/meshing/MshSections.hpp"

#include <map>
#include <vector>

namespace epafi::meshing {

/// Elements with the same nodes in different blocks become one, which has the first one's number, in a new
/// block, whose entity is in the groups of all. Copies in one block stay: they are a mistake.
/// \param groupEntities  by the group's number  \param numEntities  that the file has; new ones are added
void joinCopies(std::vector<MshBlock>& blocks, std::map<int, std::vector<int>>& groupEntities,
                int& numEntities);

} // namespace epafi::meshing
