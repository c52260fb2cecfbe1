#pragma once

/// The XML beside an HDF5 file that tells ParaView and VTK what its datasets mean (XDMF, version 2, which
/// their readers for Xdmf2 and Xdmf3 both open).

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Cell.hpp"

#include <optional>
#include <string>
#include <vector>

namespace epafi::output {

/// A dataset of the HDF5 file, exactly as it lies there.
struct XdmfData {
  std::string dataset; ///< path within the file, or within the group of a load step
  GlobalOrdinal rows = 0;
  int columns = 0; ///< 0: one-dimensional
  enum class Type { real8, integer4, integer8 } type = Type::real8;
  bool isOfStep = false; ///< each load step has one in its group
};

/// A field on nodes or cells.
struct XdmfAttribute {
  std::string name;
  enum class Center { node, cell } center = Center::node;
  XdmfData data; ///< one column (or one dimension): scalar, three: vector, else matrix
};

/// A mesh.
struct XdmfGrid {
  std::string name;
  XdmfData points;                        ///< n × 3
  std::optional<mesh::CellType> cellType; ///< nothing: points
  XdmfData cells; ///< n_e × nodes of a cell, in the order of VTK, which is that of CellType; points: n × 1
  std::vector<XdmfAttribute> attributes;
  /// Of cells of several types their number; then `cells` is a sequence: of each its xdmfNumber and its
  /// nodes.
  std::optional<GlobalOrdinal> numMixed{};
};

/// Number of a type among cells of several types.
int xdmfNumber(mesh::CellType type);

/// A load step, whose time is its number.
struct XdmfStep {
  std::string name;
  int number = 1;
  std::string group; ///< path in the file of the group that has its datasets
};

/// The document: a spatial collection of the grids, or, of a scene in load steps, a temporal collection of
/// such, one a step. Names are escaped. `hdf5File` is the name of the HDF5 file relative to the document. Not
/// collective.
std::string xdmfDocument(const std::string& hdf5File, const std::vector<XdmfGrid>& grids,
                         const std::vector<XdmfStep>& steps = {});

} // namespace epafi::output
