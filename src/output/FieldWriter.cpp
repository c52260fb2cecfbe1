#include "epafi/output/FieldWriter.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/output/BodyFields.hpp"
#include "epafi/output/ContactFields.hpp"
#include "epafi/output/Hdf5File.hpp"
#include "epafi/output/SafeNames.hpp"
#include "epafi/output/Xdmf.hpp"
#include "epafi/simulation/JointResults.hpp"

#include <algorithm>
#include <span>

namespace epafi::output {
namespace {

using Type = XdmfData::Type;
using Center = XdmfAttribute::Center;

/// Where fields go: the file itself, or the group of a load step, which is laid out as the file is.
struct FieldGroup {
  Hdf5File& file;
  std::string path;  ///< of a step's group; empty: the file itself
  std::string first; ///< of the first step's group, which has the meshes of all of them

  void createGroup(const std::string& group) { file.createGroup(path + group); }
  void attribute(const std::string& group, const std::string& name, const std::string& value) {
    file.attribute(path + group, name, value);
  }
};

template <class T>
constexpr Type typeOf = std::is_same_v<T, double> ? Type::real8
                        : sizeof(T) == 4          ? Type::integer4
                                                  : Type::integer8;

/// Writes a table and says where it lies.
template <class T>
XdmfData put(FieldGroup& to, const std::string& dataset, GlobalOrdinal rows, int columns,
             const RowRange& range, const std::vector<T>& values) {
  to.file.write(to.path + dataset, rows, columns, range, std::span<const T>(values));
  return {dataset, rows, columns, typeOf<T>, true};
}

/// The same of a table that no load step changes: it is there once.
template <class T>
XdmfData putShared(FieldGroup& to, const std::string& dataset, GlobalOrdinal rows, int columns,
                   const RowRange& range, const std::vector<T>& values) {
  if (to.path == to.first)
    put(to, dataset, rows, columns, range, values);
  else
    to.file.link(to.path + dataset, to.first + dataset);
  return {to.first + dataset, rows, columns, typeOf<T>};
}

/// The cells of a grid as rows (mesh/Cell.hpp); of several types also as XDMF has these. Collective.
void putCells(FieldGroup& file, const std::string& group, GlobalOrdinal number, mesh::CellType largest,
              const RowRange& range, const std::vector<long long>& rows, const Comm& comm, XdmfGrid& grid) {
  const std::size_t length = numNodesOf(largest);
  grid.cellType = largest;
  grid.cells = putShared(file, group + "/cells", number, numNodesOf(largest), range, rows);
  std::vector<long long> sequence;
  bool isMixed = false;
  for (std::size_t begin = 0; begin < rows.size(); begin += length) {
    const auto nodes = mesh::withoutFilling(std::span(rows).subspan(begin, length));
    isMixed = isMixed || nodes.size() < length;
    sequence.push_back(xdmfNumber(cellOf(largest, nodes.size())));
    sequence.insert(sequence.end(), nodes.begin(), nodes.end());
  }
  if (maxOverRanks(comm, isMixed ? 1 : 0) == 0)
    return;
  const GlobalOrdinal own = std::ssize(sequence);
  grid.numMixed = number;
  grid.cells = putShared(file, group + "/cells_by_type", sumOverRanks(comm, own), 0,
                         {sumBefore(comm, own), own}, sequence);
}

/// Rows of two numbers become rows of three, the last one 0.
std::vector<double> inSpace(const std::vector<double>& plane) {
  std::vector<double> space;
  space.reserve(plane.size() / 2 * 3);
  for (std::size_t k = 0; k + 1 < plane.size(); k += 2)
    space.insert(space.end(), {plane[k], plane[k + 1], 0.0});
  return space;
}

/// What elastic bodies have beside membranes: a vector to warp by, and stress.
void putElastic(FieldGroup& file, const std::string& group, const BodyFields& fields, const XdmfData& u,
                const std::vector<double>& vonMises, XdmfGrid& grid) {
  const GlobalOrdinal n = fields.numNodes;
  const XdmfData displacement =
      u.columns == 3 ? u : put(file, group + "/displacement", n, 3, fields.nodes, inSpace(fields.u));
  grid.attributes.push_back({"displacement", Center::node, displacement});
  grid.attributes.push_back(
      {"von_mises", Center::node, put(file, group + "/von_mises", n, 0, fields.nodes, vonMises)});
}

XdmfGrid putBody(FieldGroup& file, const std::string& group, const simulation::SolvedScene& solved,
                 const simulation::Evaluation& evaluation, int body) {
  const BodyFields fields = gatherBodyFields(solved, body);
  const std::size_t place = body;
  const std::string& name = solved.decomposition.bodies[place].name;
  file.createGroup(group);
  file.attribute(group, "name", name);
  file.attribute(group, "cell_type", std::string(mesh::toString(fields.cellType)));
  file.attribute(group, "physics", toString(solved.scene.bodies[place].physics));
  const GlobalOrdinal n = fields.numNodes;
  const GlobalOrdinal cells = fields.numCells;
  XdmfGrid grid;
  grid.name = name;
  grid.points = putShared(file, group + "/points", n, 3, fields.nodes, fields.points);
  putCells(file, group, cells, fields.cellType, fields.cells, fields.corners, solved.comm(), grid);
  const XdmfData u =
      put(file, group + "/u", n, solved.decomposition.problem.components, fields.nodes, fields.u);
  const XdmfData subdomain = putShared(file, group + "/subdomain", cells, 0, fields.cells, fields.subdomain);
  putShared(file, group + "/crosspoints", fields.numCrosspoints, 3, fields.crosspoints,
            fields.crosspointPoints);
  if (solved.elasticBody(body) != nullptr)
    putElastic(file, group, fields, u, evaluation.vonMises[place], grid);
  else
    grid.attributes.push_back({"u", Center::node, u});
  grid.attributes.push_back({"subdomain", Center::cell, subdomain});
  if (evaluation.hasErrors)
    grid.attributes.push_back(
        {"error", Center::cell,
         put(file, group + "/error", cells, 0, fields.cells, evaluation.errors[place])});
  return grid;
}

XdmfGrid putContact(FieldGroup& file, const std::string& group, const std::string& name,
                    const std::string& firstBody, const ContactFields& fields, const Comm& comm) {
  file.createGroup(group);
  file.attribute(group, "name", name);
  file.attribute(group, "first_body", firstBody);
  if (fields.facetType)
    file.attribute(group, "cell_type", std::string(mesh::toString(*fields.facetType)));
  const GlobalOrdinal n = fields.numRows;
  XdmfGrid grid;
  grid.name = name;
  grid.points = putShared(file, group + "/points", n, 3, fields.rows, fields.points);
  if (fields.facetType)
    putCells(file, group, fields.numFacets, *fields.facetType, fields.facets, fields.corners, comm, grid);
  else
    grid.cells = putShared(file, group + "/cells", fields.numFacets, 1, fields.facets, fields.corners);
  grid.attributes.push_back(
      {"normal", Center::node, putShared(file, group + "/normal", n, 3, fields.rows, fields.normals)});
  const auto column = [&](const std::string& field, const auto& values) {
    grid.attributes.push_back(
        {field, Center::node, put(file, group + "/" + field, n, 0, fields.rows, values)});
  };
  grid.attributes.push_back(
      {"area", Center::node, putShared(file, group + "/area", n, 0, fields.rows, fields.areas)});
  column("initial_gap", fields.initialGap);
  column("gap", fields.gap);
  column("multiplier", fields.multiplier);
  column("force", fields.force);
  column("pressure", fields.pressure);
  column("active", fields.active);
  if (fields.friction) {
    const auto vectors = [&](const std::string& field, const std::vector<double>& values) {
      grid.attributes.push_back(
          {field, Center::node, put(file, group + "/" + field, n, 3, fields.rows, values)});
    };
    vectors("traction", fields.friction->traction);
    vectors("slip", fields.friction->slip);
    column("friction_state", fields.friction->state);
  }
  return grid;
}

/// The mesh on the other side of mortars.
void putFacing(FieldGroup& file, const std::string& group, const FacingSurface& facing) {
  if (facing.numFacets == 0)
    return;
  file.createGroup(group);
  putShared(file, group + "/points", facing.numPoints, 3, facing.points, facing.places);
  putShared(file, group + "/cells", facing.numFacets, facing.cornersPerFacet, facing.facets, facing.corners);
}

XdmfGrid putTie(FieldGroup& file, const std::string& group, const std::string& name,
                const simulation::TieFields& fields) {
  file.createGroup(group);
  file.attribute(group, "name", name);
  std::vector<long long> cells;
  for (GlobalOrdinal k = 0; k < fields.nodes.count; ++k)
    cells.push_back(fields.nodes.first + k);
  XdmfGrid grid;
  grid.name = name;
  grid.points = putShared(file, group + "/points", fields.numNodes, 3, fields.nodes, fields.points);
  grid.cells = putShared(file, group + "/cells", fields.numNodes, 1, fields.nodes, cells);
  grid.attributes.push_back(
      {"traction", Center::node,
       put(file, group + "/traction", fields.numNodes, 3, fields.nodes, fields.traction)});
  return grid;
}

/// The history; every rank has it whole, rank 0 writes it.
void putHistory(FieldGroup& file, const qp::History& history, const Comm& comm) {
  using Record = qp::StepRecord;
  file.createGroup("/history");
  const GlobalOrdinal rows = history.size();
  const RowRange range{0, comm.getRank() == 0 ? rows : 0};
  const auto column = [&]<class T>(const std::string& name, T, auto member) { // T: what is written
    std::vector<T> values;
    for (GlobalOrdinal k = 0; k < range.count; ++k)
      values.push_back(static_cast<T>(history[k].*member));
    put(file, "/history/" + name, rows, 0, range, values);
  };
  column("iteration", 0, &Record::iteration);
  column("outer", 0, &Record::outer);
  column("step", static_cast<signed char>(0), &Record::kind);
  column("projected_gradient", 0.0, &Record::projectedGradient);
  column("constraint_residual", 0.0, &Record::constraintResidual);
  column("objective", 0.0, &Record::objective);
  column("active_bounds", 0LL, &Record::activeBounds);
  column("hessian_multiplications", 0, &Record::hessianMultiplications);
}

/// \param group  "/" or that of a step
void putSums(Hdf5File& file, const std::string& group, const fetidp::ContactSolution& solution) {
  file.attribute(group, "energy", solution.energy);
  file.attribute(group, "contact_force", solution.contactForce);
}

void putHead(Hdf5File& file, const model::Decomposition& decomposition,
             const fetidp::ContactSolution& solution) {
  file.attribute("/", "program", std::string("Epafi"));
  file.attribute("/", "format", 1LL);
  file.attribute("/", "components", GlobalOrdinal{decomposition.problem.components});
  putSums(file, "/", solution);
}

template <class Layouts>
std::vector<std::string> groupNames(const Layouts& layouts) {
  std::vector<std::string> names;
  for (const auto& layout : layouts)
    names.push_back(layout.name);
  return safeNames(names);
}

/// All that the file has of a solution. Returns what of it has a mesh.
std::vector<XdmfGrid> putFields(FieldGroup& file, const simulation::SolvedScene& solved,
                                const simulation::Evaluation& evaluation, const qp::History& history) {
  const model::Decomposition& decomposition = solved.decomposition;
  std::vector<XdmfGrid> grids;
  file.createGroup("/bodies");
  file.createGroup("/contact");
  const auto bodyGroups = groupNames(decomposition.bodies);
  for (int b = 0; b < std::ssize(bodyGroups); ++b)
    grids.push_back(putBody(file, "/bodies/" + bodyGroups[b], solved, evaluation, b));
  const auto contactGroups = groupNames(decomposition.contacts);
  for (int c = 0; c < std::ssize(contactGroups); ++c) {
    grids.push_back(putContact(file, "/contact/" + contactGroups[c], decomposition.contacts[c].name,
                               bodyGroups[decomposition.contacts[c].firstBody],
                               gatherContactFields(solved, c, evaluation.contacts[c]), solved.comm()));
    putFacing(file, "/contact/" + contactGroups[c] + "/facing", facingSurface(solved, c));
  }
  const auto tieGroups = groupNames(decomposition.ties);
  if (!tieGroups.empty())
    file.createGroup("/tied");
  for (std::size_t t = 0; t < tieGroups.size(); ++t)
    grids.push_back(putTie(file, "/tied/" + tieGroups[t], decomposition.ties[t].name,
                           simulation::gatherTieFields(solved, decomposition.ties[t])));
  putHistory(file, history, *decomposition.problem.comm);
  return grids;
}

/// The fields of the last one of these steps, in a group of its own, and under the names that those of a
/// scene without steps have.
std::vector<XdmfGrid> putStep(Hdf5File& file, const std::vector<XdmfStep>& steps,
                              const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
                              const qp::History& history) {
  const std::string& group = steps.back().group;
  file.createGroup(group);
  file.attribute(group, "name", steps.back().name);
  file.attribute(group, "number", GlobalOrdinal{steps.back().number});
  putSums(file, group, solved.solution);
  FieldGroup own{file, group, steps.front().group};
  const std::vector<XdmfGrid> grids = putFields(own, solved, evaluation, history);
  std::vector<std::string> parts{"/bodies", "/contact", "/history"};
  if (!solved.decomposition.ties.empty())
    parts.emplace_back("/tied");
  for (const std::string& part : parts)
    file.link(part, group + part);
  return grids;
}

/// The steps with the groups that they have in the file.
std::vector<XdmfStep> inGroups(const std::vector<FieldStep>& steps) {
  const std::vector<std::string> groups = groupNames(steps);
  std::vector<XdmfStep> result;
  for (std::size_t k = 0; k < steps.size(); ++k)
    result.push_back({steps[k].name, steps[k].number, "/steps/" + groups[k]});
  return result;
}

} // namespace

FieldFiles writeFields(const std::filesystem::path& directory, const std::string& name,
                       const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
                       const qp::History& history) {
  FileSet own(solved.decomposition.problem.comm);
  FieldFiles files = writeFields(directory, name, solved, evaluation, history, own);
  own.publish();
  return files;
}

FieldFiles writeFields(const std::filesystem::path& directory, const std::string& name,
                       const simulation::SolvedScene& solved, const simulation::Evaluation& evaluation,
                       const qp::History& history, FileSet& together, const std::vector<FieldStep>& steps,
                       const std::filesystem::path& older) {
  if (name.empty() || name.find('/') != std::string::npos) // the same on all ranks
    throw InputError("'" + name + "' is no name for an output file; it must not be empty nor contain '/'.");
  const auto& problem = solved.decomposition.problem;
  const std::vector<XdmfStep> placed = inGroups(steps);
  FieldFiles files{directory / (name + ".h5"), directory / (name + ".xdmf")};

  Hdf5File file(files.hdf5, problem.comm,
                steps.size() < 2 ? std::filesystem::path()
                : older.empty()  ? files.hdf5
                                 : older);
  if (steps.size() > 1)
    file.removeAllBut("/steps", groupNames(std::vector(steps.begin(), steps.end() - 1)));
  putHead(file, solved.decomposition, solved.solution);
  FieldGroup whole{file, "", ""};
  const std::vector<XdmfGrid> grids = steps.empty() ? putFields(whole, solved, evaluation, history)
                                                    : putStep(file, placed, solved, evaluation, history);
  FileSet both(problem.comm, together.syncs());
  both.add(file.complete(), files.hdf5);
  both.write(
      files.xdmf, [&] { return xdmfDocument(name + ".h5", grids, placed); }, FileSet::Older::goesFirst);
  together.take(both);
  return files;
}

} // namespace epafi::output
