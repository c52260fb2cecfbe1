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
  std::string dataset; ///< path within the file
  GlobalOrdinal rows = 0;
  int columns = 0; ///< 0: one-dimensional
  enum class Type { real8, integer4, integer8 } type = Type::real8;
};

/// A field on nodes or cells.
struct XdmfAttribute {
  std::string name;
  enum class Center { node, cell } center = Center::node;
  XdmfData data; ///< one column (or one dimension): scalar, three: vector, else matrix
};

/// A mesh of cells of one kind.
struct XdmfGrid {
  std::string name;
  XdmfData points;                        ///< n × 3
  std::optional<mesh::CellType> cellType; ///< nothing: points
  XdmfData cells; ///< n_e × nodes of a cell, in the order of VTK, which is that of CellType; points: n × 1
  std::vector<XdmfAttribute> attributes;
};

/// The document: a spatial collection of the grids. Names are escaped. `hdf5File` is the name of the HDF5
/// file relative to the document. Not collective.
std::string xdmfDocument(const std::string& hdf5File, const std::vector<XdmfGrid>& grids);

} // namespace epafi::output
