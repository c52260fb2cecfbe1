#pragma once

/// What the sections of a mesh file say, as they say it. One function a section; each begins behind the section's first line
/// and ends before its last one. They throw InputError at what does not fit the format, and allocate in proportion to
/// the file's size, whatever it promises.

#include "epafi/fem/Mesh.hpp"
#include "epafi/fem/MshScanner.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace epafi::fem {

/// Elements of one linear kind on one entity.
struct MshBlock {
  int entity = 0;
  int type = 0;
  std::vector<GlobalOrdinal> tags;
  std::vector<GlobalOrdinal> nodes; ///< by their tags
};

struct MshRecords {
  std::map<std::pair<int, int>, std::string> groupNames;        ///< by dimension and number
  std::array<std::map<int, std::vector<int>>, 4> groupEntities; ///< of each dimension: by the group's number
  std::vector<GlobalOrdinal> nodeTags;                          ///< ≥ 0
  std::vector<Point> points;
  std::vector<std::array<int, 2>> nodeEntities; ///< dimension and number
  std::array<std::vector<MshBlock>, 4> blocks;  ///< of each dimension
};

/// In both formats: numbers and names of physical groups.
void readPhysicalNames(MshScanner& file, MshRecords& records);

/// Format 2.2. It has no entities; elements that share group and entity's number make up one here, numbered anew.
/// \param isParametric  whether the section is $ParametricNodes
void readNodes2(MshScanner& file, MshRecords& records, bool isParametric);
void readElements2(MshScanner& file, MshRecords& records);

/// Format 4.1. \param isPartitioned  whether the section is $PartitionedEntities
void readEntities4(MshScanner& file, MshRecords& records, bool isPartitioned);
void readNodes4(MshScanner& file, MshRecords& records);
void readElements4(MshScanner& file, MshRecords& records);

/// Nodes of an element of that kind. Throws if it is not a linear one.
int numNodesOfMsh(const MshScanner& file, int type, GlobalOrdinal element);
/// A node's tag. Throws if it is negative.
GlobalOrdinal checkedTag(const MshScanner& file, GlobalOrdinal tag);
/// Number of the physical group that a tag names; a negative one means that group, too, seen from the other side.
int groupOfTag(const MshScanner& file, int tag);

} // namespace epafi::fem
