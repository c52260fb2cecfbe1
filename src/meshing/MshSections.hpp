#pragma once

/// What the sections of a mesh file say, as they say it. One function a section; each begins behind the
/// section's first line and ends before its last one. They throw InputError at what does not fit the format,
/// and allocate in proportion to the file's size, whatever it promises.

#include "epafi/meshing/MshReader.hpp"
#include "epafi/meshing/MshScanner.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace epafi::meshing {

/// A block whose nodes are known by their tags alone.
struct MshBlock {
  GmshBlock block;
  std::vector<GlobalOrdinal> nodes;
};

struct MshRecords {
  std::map<std::pair<int, int>, std::string> groupNames;        ///< by dimension and number
  std::array<std::map<int, std::vector<int>>, 4> groupEntities; ///< of each dimension: by the group's number
  GlobalOrdinal numPartitions = 0;     ///< of the whole mesh; 0: the file does not say
  std::vector<GlobalOrdinal> nodeTags; ///< ≥ 0
  std::vector<Point> points;
  std::vector<std::array<int, 2>> nodeEntities; ///< dimension and number
  std::array<std::vector<MshBlock>, 4> blocks;  ///< of each dimension
};

/// In both formats: numbers and names of physical groups.
void readPhysicalNames(MshScanner& file, MshRecords& records);

/// Format 2.2. It has no entities: here the elements of one kind and group, or of the same groups, are one,
/// with a number of its own.
/// \param isParametric  whether the section is $ParametricNodes
void readNodes2(MshScanner& file, MshRecords& records, bool isParametric);
void readElements2(MshScanner& file, MshRecords& records);

/// Format 4.1. \param isPartitioned  whether the section is $PartitionedEntities
void readEntities4(MshScanner& file, MshRecords& records, bool isPartitioned);
void readNodes4(MshScanner& file, MshRecords& records);
void readElements4(MshScanner& file, MshRecords& records);

} // namespace epafi::meshing
