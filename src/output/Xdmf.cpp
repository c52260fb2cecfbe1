#include "epafi/output/Xdmf.hpp"

#include <array>
#include <map>
#include <sstream>

namespace epafi::output {
namespace {

std::string escaped(const std::string& text) {
  static const std::map<char, const char*> entities{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string result;
  for (const char letter : text)
    if (const auto entity = entities.find(letter); entity != entities.end())
      result += entity->second;
    else
      result += letter;
  return result;
}

struct XdmfCell {
  const char*
      name; ///< value of TopologyType, and the attribute that goes with it where cells are of any length
  int number;
};

/// In the order of CellType.
constexpr std::array xdmfCells{XdmfCell{"Triangle", 4},
                               XdmfCell{"Quadrilateral", 5},
                               XdmfCell{"Tetrahedron", 6},
                               XdmfCell{"Pyramid", 7},
                               XdmfCell{"Wedge", 8},
                               XdmfCell{"Hexahedron", 9},
                               XdmfCell{"Polyline\" NodesPerElement=\"2", 2},
                               XdmfCell{"Triangle_6", 36},
                               XdmfCell{"Quadrilateral_9", 35},
                               XdmfCell{"Tetrahedron_10", 38},
                               XdmfCell{"Pyramid_13", 39},
                               XdmfCell{"Wedge_15", 40},
                               XdmfCell{"Hexahedron_27", 50},
                               XdmfCell{"Edge_3", 34},
                               XdmfCell{"Quadrilateral_8", 37},
                               XdmfCell{"Hexahedron_20", 48}};

const char* nameOf(std::optional<mesh::CellType> type) {
  return type ? xdmfCells.at(static_cast<std::size_t>(*type)).name : "Polyvertex\" NodesPerElement=\"1";
}

/// Writes the document's elements with the name of the HDF5 file at hand.
class Writer {
public:
  explicit Writer(const std::string& hdf5File) : hdf5File_(escaped(hdf5File)) {}

  /// \param step  null: of a scene without load steps
  void scene(const std::vector<XdmfGrid>& grids, const XdmfStep* step) {
    text_ << "    <Grid Name=\"" << (step != nullptr ? escaped(step->name) : "scene")
          << "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n";
    if (step != nullptr)
      text_ << "      <Time Value=\"" << step->number << "\"/>\n";
    group_ = step != nullptr ? escaped(step->group) : "";
    for (const XdmfGrid& part : grids)
      grid(part);
    text_ << "    </Grid>\n";
  }

  [[nodiscard]] std::string text() const { return text_.str(); }

private:
  void grid(const XdmfGrid& grid) {
    text_ << "      <Grid Name=\"" << escaped(grid.name) << "\" GridType=\"Uniform\">\n";
    text_ << "        <Topology TopologyType=\"" << (grid.numMixed ? "Mixed" : nameOf(grid.cellType))
          << "\" NumberOfElements=\"" << grid.numMixed.value_or(grid.cells.rows) << "\">\n";
    item(grid.cells);
    text_ << "        </Topology>\n";
    text_ << "        <Geometry GeometryType=\"XYZ\">\n";
    item(grid.points);
    text_ << "        </Geometry>\n";
    for (const XdmfAttribute& field : grid.attributes)
      attribute(field);
    text_ << "      </Grid>\n";
  }

  void attribute(const XdmfAttribute& field) {
    const int columns = field.data.columns;
    const char* kind = columns <= 1 ? "Scalar" : columns == 3 ? "Vector" : "Matrix";
    const char* center = field.center == XdmfAttribute::Center::node ? "Node" : "Cell";
    text_ << "        <Attribute Name=\"" << escaped(field.name) << "\" AttributeType=\"" << kind
          << "\" Center=\"" << center << "\">\n";
    item(field.data);
    text_ << "        </Attribute>\n";
  }

  void item(const XdmfData& data) {
    text_ << "          <DataItem Format=\"HDF\" Dimensions=\"" << data.rows;
    if (data.columns > 0)
      text_ << ' ' << data.columns;
    text_ << "\" NumberType=\"" << (data.type == XdmfData::Type::real8 ? "Float" : "Int") << "\" Precision=\""
          << (data.type == XdmfData::Type::integer4 ? 4 : 8) << "\">" << hdf5File_ << ':'
          << (data.isOfStep ? group_ : "") << escaped(data.dataset) << "</DataItem>\n";
  }

  std::string hdf5File_;
  std::string group_; ///< of the step at hand
  std::ostringstream text_;
};

} // namespace

int xdmfNumber(mesh::CellType type) {
  return xdmfCells.at(static_cast<std::size_t>(type)).number;
}

std::string xdmfDocument(const std::string& hdf5File, const std::vector<XdmfGrid>& grids,
                         const std::vector<XdmfStep>& steps) {
  Writer writer(hdf5File);
  if (steps.empty())
    writer.scene(grids, nullptr);
  for (const XdmfStep& step : steps)
    writer.scene(grids, &step);
  const std::string begin = "    <Grid Name=\"steps\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<Xdmf Version=\"2.0\">\n"
         "  <Domain>\n" +
         (steps.empty() ? writer.text() : begin + writer.text() + "    </Grid>\n") +
         "  </Domain>\n"
         "</Xdmf>\n";
}

} // namespace epafi::output
