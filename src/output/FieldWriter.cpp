#include "epafi/output/FieldWriter.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/BodyFields.hpp"
#include "epafi/output/ContactFields.hpp"
#include "epafi/output/Hdf5File.hpp"
#include "epafi/output/Names.hpp"
#include "epafi/output/Xdmf.hpp"

#include <numeric>

namespace epafi::output {
namespace {

using Type = XdmfData::Type;
using Center = XdmfAttribute::Center;

/// Writes a table and says where it lies.
template <class T>
XdmfData put(Hdf5File& file, const std::string& dataset, GlobalOrdinal rows, int columns,
             const RowRange& range, const std::vector<T>& values) {
  file.write(dataset, rows, columns, range, std::span<const T>(values));
  const Type type = std::is_same_v<T, double> ? Type::real8
                    : sizeof(T) == 4          ? Type::integer4
                                              : Type::integer8;
  return {dataset, rows, columns, type};
}

XdmfGrid putBody(Hdf5File& file, const std::string& group, const std::string& name, const BodyFields& fields,
                 int components) {
  file.createGroup(group);
  file.attribute(group, "name", name);
  const GlobalOrdinal n = fields.numNodes;
  const GlobalOrdinal cells = fields.numCells;
  XdmfGrid grid;
  grid.name = name;
  grid.points = put(file, group + "/points", n, 3, fields.nodes, fields.points);
  grid.cells = put(file, group + "/cells", cells, fields.nodesPerCell, fields.cells, fields.corners);
  const XdmfData u = put(file, group + "/u", n, components, fields.nodes, fields.u);
  const XdmfData subdomain = put(file, group + "/subdomain", cells, 0, fields.cells, fields.subdomain);
  put(file, group + "/crosspoints", fields.numCrosspoints, 3, fields.crosspoints, fields.crosspointPoints);
  grid.attributes = {{"u", Center::node, u}, {"subdomain", Center::cell, subdomain}};
  return grid;
}

XdmfGrid putContact(Hdf5File& file, const std::string& group, const std::string& name,
                    const ContactFields& fields) {
  file.createGroup(group);
  file.attribute(group, "name", name);
  const GlobalOrdinal n = fields.numRows;
  XdmfGrid grid;
  grid.name = name;
  grid.points = put(file, group + "/points", n, 3, fields.rows, fields.points);
  std::vector<long long> vertices(
      static_cast<std::size_t>(fields.rows.count)); // readers draw nothing without
  std::iota(vertices.begin(), vertices.end(), fields.rows.first);
  grid.cells = put(file, group + "/cells", n, 1, fields.rows, vertices);
  const auto column = [&](const std::string& field, const auto& values) {
    grid.attributes.push_back(
        {field, Center::node, put(file, group + "/" + field, n, 0, fields.rows, values)});
  };
  column("initial_gap", fields.initialGap);
  column("gap", fields.gap);
  column("multiplier", fields.multiplier);
  column("active", fields.active);
  return grid;
}

/// One column of the history; every rank has it whole, rank 0 writes it.
template <class T, class Value>
void putHistoryColumn(Hdf5File& file, const std::string& name, const qp::History& history, const Comm& comm,
                      Value value) {
  const auto rows = static_cast<GlobalOrdinal>(history.size());
  const RowRange range = onFirstRank(rows, comm);
  std::vector<T> column;
  for (GlobalOrdinal k = 0; k < range.count; ++k)
    column.push_back(static_cast<T>(value(history[static_cast<std::size_t>(k)])));
  file.write("/history/" + name, rows, 0, range, std::span<const T>(column));
}

void putHistory(Hdf5File& file, const qp::History& history, const Comm& comm) {
  using Record = qp::StepRecord;
  file.createGroup("/history");
  const auto integers = [&](const std::string& name, auto value) {
    putHistoryColumn<int>(file, name, history, comm, value);
  };
  const auto reals = [&](const std::string& name, auto value) {
    putHistoryColumn<double>(file, name, history, comm, value);
  };
  integers("iteration", [](const Record& record) { return record.iteration; });
  integers("outer", [](const Record& record) { return record.outer; });
  putHistoryColumn<signed char>(file, "step", history, comm,
                                [](const Record& record) { return record.kind; });
  reals("projected_gradient", [](const Record& record) { return record.projectedGradient; });
  reals("constraint_residual", [](const Record& record) { return record.constraintResidual; });
  reals("objective", [](const Record& record) { return record.objective; });
  putHistoryColumn<long long>(file, "active_bounds", history, comm,
                              [](const Record& record) { return record.activeBounds; });
  integers("hessian_multiplications", [](const Record& record) { return record.hessianMultiplications; });
}

void putHead(Hdf5File& file, const decomposition::Decomposition& decomposition,
             const fetidp::ContactSolution& solution) {
  file.attribute("/", "program", std::string("Epafi"));
  file.attribute("/", "format", 1LL);
  file.attribute("/", "components", static_cast<long long>(decomposition.problem.components));
  file.attribute("/", "energy", solution.energy);
  file.attribute("/", "contact_force", solution.contactForce);
}

template <class Layouts>
std::vector<std::string> groupNames(const Layouts& layouts) {
  std::vector<std::string> names;
  for (const auto& layout : layouts)
    names.push_back(layout.name);
  return safeNames(names);
}

} // namespace

FieldFiles writeFields(const std::filesystem::path& directory, const std::string& name,
                       const decomposition::Decomposition& decomposition,
                       const fetidp::ContactSolution& solution, const qp::History& history) {
  if (name.empty() || name.find('/') != std::string::npos) // the same on all ranks
    throw InputError("'" + name + "' is no name for an output file; it must not be empty nor contain '/'.");
  const auto& problem = decomposition.problem;
  FieldFiles files{directory / (name + ".h5"), directory / (name + ".xdmf")};

  std::vector<XdmfGrid> grids;
  Hdf5File file(files.hdf5, problem.comm);
  putHead(file, decomposition, solution);
  file.createGroup("/bodies");
  file.createGroup("/contact");
  const auto bodyGroups = groupNames(decomposition.bodies);
  for (std::size_t b = 0; b < bodyGroups.size(); ++b)
    grids.push_back(putBody(file, "/bodies/" + bodyGroups[b], decomposition.bodies[b].name,
                            gatherBodyFields(decomposition, solution, static_cast<int>(b)),
                            problem.components));
  const auto contactGroups = groupNames(decomposition.contacts);
  for (std::size_t c = 0; c < contactGroups.size(); ++c)
    grids.push_back(putContact(file, "/contact/" + contactGroups[c], decomposition.contacts[c].name,
                               gatherContactFields(decomposition, solution, static_cast<int>(c))));
  putHistory(file, history, *problem.comm);
  file.close();
  writeTextFile(
      files.xdmf, [&] { return xdmfDocument(name + ".h5", grids); }, *problem.comm);
  return files;
}

} // namespace epafi::output
