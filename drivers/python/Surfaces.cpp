#include "Arrays.hpp"
#include "Doors.hpp"
#include "Sparse.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/contact/SurfaceContact.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <pybind11/stl.h>

#include <optional>
#include <set>

namespace epafi::python {
namespace {

/// Of facets of order 1. \param facets  m × k, seen from outside
mesh::Surface surfaceOf(const Row<GlobalOrdinal>& facets) {
  using mesh::CellType;
  mesh::Surface surface;
  surface.facetType = facets.shape(1) == 2   ? CellType::line
                      : facets.shape(1) == 3 ? CellType::triangle
                                             : CellType::quadrilateral;
  surface.facetNodes.assign(facets.data(), facets.data() + facets.size());
  surface.elements.resize(facets.shape(0));
  return surface;
}

/// B as indptr, indices and data.
py::tuple rowsOf(const CrsMatrix& matrix) {
  std::vector<int> starts{0}, columns;
  std::vector<double> entries;
  for (LocalOrdinal row = 0; row < static_cast<LocalOrdinal>(numLocal(*matrix.getRowMap())); ++row) {
    CrsMatrix::local_inds_host_view_type own;
    CrsMatrix::values_host_view_type values;
    matrix.getLocalRowView(row, own, values);
    for (std::size_t k = 0; k < own.extent(0); ++k) {
      columns.push_back(static_cast<int>(matrix.getColMap()->getGlobalElement(own(k))));
      entries.push_back(values(k));
    }
    starts.push_back(static_cast<int>(columns.size()));
  }
  return py::make_tuple(arrayOf(std::move(starts)), arrayOf(std::move(columns)), arrayOf(std::move(entries)));
}

/// Rows between two surfaces by mortars, the first with the multipliers.
/// \param points  of the nodes of all bodies
/// \param held    of a tie unknowns that supports hold; nothing: contact
py::dict jointOf(const std::string& name, int components, const Row<double>& points,
                 const Row<GlobalOrdinal>& first, const Row<GlobalOrdinal>& second, double distance,
                 double gap, const std::optional<std::set<GlobalOrdinal>>& held) {
  contact::ContactTerms terms;
  terms.name = terms.firstSurface = name;
  terms.dimension = static_cast<int>(points.shape(1));
  terms.components = components;
  terms.distance = distance;
  terms.gap = gap;
  const auto places = points.unchecked<2>();
  const contact::NodePoints pointAt = [&places](GlobalOrdinal node) {
    Point point{};
    for (py::ssize_t c = 0; c < places.shape(1); ++c)
      point[static_cast<std::size_t>(c)] = places(node, c);
    return point;
  };
  const contact::HeldNodes isHeld = [&](GlobalOrdinal node, const Eigen::Vector3d& direction) {
    Eigen::Index axis = 0;
    return direction.cwiseAbs().maxCoeff(&axis) == 1 && held->contains(node * components + axis);
  };
  const mesh::Surface own = surfaceOf(first), other = surfaceOf(second);
  const RCP<const Comm> comm = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  contact::CoupledSurfaces joint;
  {
    const py::gil_scoped_release noLock;
    joint = held ? contact::tieBetween(terms, {own, pointAt}, {other, pointAt}, comm, isHeld)
                 : contact::contactBetween(terms, {own, pointAt}, {other, pointAt}, comm);
  }
  const auto gaps = joint.matrix.gap->getData();
  using namespace py::literals;
  return py::dict("rows"_a = rowsOf(*joint.matrix.rows),
                  "gaps"_a = arrayOf(std::vector<double>(gaps.begin(), gaps.end())),
                  "areas"_a = arrayOf(std::move(joint.rows.areas)),
                  "nodes"_a = arrayOf(std::move(joint.rows.firstNodes)),
                  "directions"_a = arrayOf(std::move(joint.rows.directions), components));
}

} // namespace

void defineSurfaces(py::module_& module) {
  module.def("joint_of", &jointOf);
}

} // namespace epafi::python
