#include "epafi/output/BodyFields.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Records.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

namespace epafi::output {
namespace {

using decomposition::Subdomain;
using model::BodyLayout;

/// The parts that hold a node, ascending, without repetition.
void partsOf(const BodyLayout& layout, GlobalOrdinal node, std::vector<GlobalOrdinal>& elements,
             std::vector<int>& parts) {
  layout.mesh->nodeElements(node, elements);
  parts.clear();
  for (const GlobalOrdinal element : elements)
    parts.push_back(layout.partition->partOf(element));
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
}

/// Whether each node of a subdomain has unknowns, and crosspoint unknowns among them.
struct NodeKinds {
  std::vector<char> free, crosspoint;

  NodeKinds(const Subdomain& subdomain, int components)
      : free(subdomain.nodes.size(), 0), crosspoint(subdomain.nodes.size(), 0) {
    for (const int position : subdomain.unknownPosition)
      free[position / components] = 1;
    const auto mark = [&](int unknown, char value) {
      const int position = subdomain.unknownPosition[unknown];
      crosspoint[position / components] = value;
    };
    for (const int unknown : subdomain.crosspointUnknowns)
      mark(unknown, 1);
    for (const decomposition::Average& average : subdomain.averages)
      mark(average.carrier, 0);
  }
};

/// Values that this rank's subdomains send: node, u (components), 1 for a crosspoint, and the node's place,
/// row by row.
struct NodeValues {
  std::vector<GlobalOrdinal> nodes;
  std::vector<double> values;
};

void appendSubdomain(const BodyLayout& layout, const Subdomain& subdomain,
                     const Eigen::VectorXd& displacement, int components, NodeValues& result) {
  const int ownPart = subdomain.number - layout.firstSubdomain;
  const NodeKinds kinds(subdomain, components);
  const bool isPlane = mesh::dimensionOf(layout.mesh->cellType()) == 2;
  std::vector<GlobalOrdinal> elements;
  std::vector<int> parts;
  for (std::size_t k = 0; k < subdomain.nodes.size(); ++k) {
    const GlobalOrdinal node = subdomain.nodes[k];
    partsOf(layout, node, elements, parts);
    if (parts.empty() || parts.front() != ownPart)
      continue;
    result.nodes.push_back(node);
    for (int component = 0; component < components; ++component)
      result.values.push_back(displacement[k * components + component]);
    const bool wouldBe =
        isPlane && (parts.size() > 2 || (parts.size() == 2 && layout.mesh->isBoundaryNode(node)));
    const bool isCrosspoint = kinds.free[k] != 0 ? kinds.crosspoint[k] != 0 : wouldBe;
    result.values.push_back(isCrosspoint ? 1 : 0);
    const Point point = layout.mesh->point(node);
    result.values.insert(result.values.end(), point.begin(), point.end());
  }
}

NodeValues valuesOfSubdomains(const simulation::SolvedScene& solved, int body) {
  const auto& [scene, decomposition, solution] = solved;
  const auto& problem = decomposition.problem;
  if (solution.displacement.size() != problem.subdomains.size())
    throw Error("The solution has displacements of " + std::to_string(solution.displacement.size()) +
                " subdomains on a rank that has " + std::to_string(problem.subdomains.size()) + ".");
  NodeValues result;
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = problem.subdomains[s];
    if (subdomain.body != body)
      continue;
    const Eigen::Index expected = subdomain.nodes.size() * problem.components;
    if (solution.displacement[s].size() != expected)
      throw Error("The displacement of subdomain " + std::to_string(subdomain.number) + " has " +
                  std::to_string(solution.displacement[s].size()) + " values instead of " +
                  std::to_string(expected) + ".");
    appendSubdomain(decomposition.bodies[body], subdomain, solution.displacement[s], problem.components,
                    result);
  }
  return result;
}

/// Moves the values to the slabs of nodes, one column each.
MultiVector toSlab(const NodeValues& sent, std::size_t columns, GlobalOrdinal numNodes,
                   const RCP<const Comm>& comm) {
  const auto source = mapInOrder(sent.nodes, comm);
  if (std::cmp_not_equal(source->getGlobalNumElements(), numNodes))
    throw Error("The subdomains of a body hold " + std::to_string(source->getGlobalNumElements()) +
                " of its " + std::to_string(numNodes) + " nodes.");
  const auto target = slabMap(numNodes, comm);
  MultiVector from(source, columns);
  for (std::size_t column = 0; column < columns; ++column) {
    const auto data = from.getDataNonConst(column);
    for (Teuchos::Ordinal row = 0; row < data.size(); ++row)
      data[row] = sent.values[row * columns + column];
  }
  MultiVector to(target, columns);
  to.doImport(from, Import(source, target), Tpetra::INSERT);
  return to;
}

void fillNodes(const MultiVector& values, int components, BodyFields& fields) {
  const auto crosspoint = values.getData(components);
  fields.u.resize(fields.nodes.count * components);
  for (int component = 0; component < components; ++component) {
    const auto data = values.getData(component);
    for (Teuchos::Ordinal row = 0; row < data.size(); ++row)
      fields.u[row * components + component] = data[row];
  }
  Teuchos::ArrayRCP<const double> place[3];
  for (std::size_t d = 0; d < 3; ++d)
    place[d] = values.getData(components + 1 + d);
  for (Teuchos::Ordinal row = 0; row < crosspoint.size(); ++row)
    for (const auto& coordinate : place) {
      fields.points.push_back(coordinate[row]);
      if (crosspoint[row] > 0)
        fields.crosspointPoints.push_back(coordinate[row]);
    }
}

/// The cells go from their subdomains to the slabs: number, subdomain, nodes. Collective.
void fillCells(const simulation::SolvedScene& solved, int body, BodyFields& fields) {
  const auto& problem = solved.decomposition.problem;
  const BodyLayout& layout = solved.decomposition.bodies[body];
  const std::size_t perCell = numNodesOf(fields.cellType), width = perCell + 2;
  std::vector<GlobalOrdinal> records;
  std::vector<int> ranks;
  collectively(*problem.comm, [&] {
    for (const Subdomain& subdomain : problem.subdomains) {
      if (subdomain.body != body)
        continue;
      for (const GlobalOrdinal cell :
           layout.partition->elementsOf(subdomain.number - layout.firstSubdomain)) {
        records.insert(records.end(), {cell, subdomain.number});
        records.resize(records.size() + perCell);
        layout.mesh->elementNodes(cell, std::span(records).last(perCell));
        ranks.push_back(rankOfRow(cell, fields.numCells, problem.comm->getSize()));
      }
    }
  });
  const std::vector<char> bytes = sendRecordBytes(problem.comm, reinterpret_cast<const char*>(records.data()),
                                                  width * sizeof(GlobalOrdinal), ranks);
  const std::size_t count = fields.cells.count;
  if (bytes.size() != count * width * sizeof(GlobalOrdinal))
    throw Error("The subdomains of a body hold other elements than it has.");
  fields.corners.resize(count * perCell);
  fields.subdomain.resize(count);
  std::vector<GlobalOrdinal> record(width);
  for (std::size_t k = 0; k < count; ++k) {
    std::memcpy(record.data(), bytes.data() + k * width * sizeof(GlobalOrdinal),
                width * sizeof(GlobalOrdinal));
    const std::size_t row = record[0] - fields.cells.first;
    fields.subdomain[row] = static_cast<int>(record[1]);
    std::copy(record.begin() + 2, record.end(), fields.corners.begin() + row * perCell);
  }
}

void numberCrosspoints(const Comm& comm, BodyFields& fields) {
  fields.crosspoints.count = fields.crosspointPoints.size() / 3;
  fields.crosspoints.first = sumBefore(comm, fields.crosspoints.count);
  fields.numCrosspoints = sumOverRanks(comm, fields.crosspoints.count);
}

} // namespace

BodyFields gatherBodyFields(const simulation::SolvedScene& solved, int body) {
  const auto& problem = solved.decomposition.problem;
  const BodyLayout& layout = solved.decomposition.bodies[body];
  NodeValues sent;
  collectively(*problem.comm, [&] { sent = valuesOfSubdomains(solved, body); });

  BodyFields fields;
  fields.numNodes = layout.mesh->numNodes();
  fields.nodes = evenShare(fields.numNodes, *problem.comm);
  fields.numCells = layout.mesh->numElements();
  fields.cells = evenShare(fields.numCells, *problem.comm);
  fields.cellType = layout.mesh->cellType();
  const std::size_t columns = problem.components + 4;
  const MultiVector values = toSlab(sent, columns, fields.numNodes, problem.comm);
  fillNodes(values, problem.components, fields);
  fillCells(solved, body, fields);
  numberCrosspoints(*problem.comm, fields);
  return fields;
}

} // namespace epafi::output
