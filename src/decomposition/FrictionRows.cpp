#include "epafi/decomposition/FrictionRows.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"

#include <Eigen/Geometry>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

using Vectors = std::map<GlobalOrdinal, Eigen::Vector3d>; ///< of a row, by node

Vectors vectorsOf(const CrsMatrix& rows, LocalOrdinal row, int components) {
  CrsMatrix::local_inds_host_view_type columns;
  CrsMatrix::values_host_view_type values;
  rows.getLocalRowView(row, columns, values);
  Vectors vectors;
  for (std::size_t k = 0; k < columns.extent(0); ++k) {
    const GlobalOrdinal unknown = rows.getColMap()->getGlobalElement(columns(k));
    vectors.try_emplace(unknown / components, Eigen::Vector3d::Zero()).first->second[unknown % components] +=
        values(k);
  }
  return vectors;
}

/// n, along which a row acts on all its nodes.
Eigen::Vector3d normalOf(const Vectors& vectors, GlobalOrdinal row) {
  constexpr double sameDirection = 1e-9;
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (const auto& [node, vector] : vectors)
    if (vector.norm() > longest.norm())
      longest = vector;
  const Eigen::Vector3d normal = longest.normalized();
  for (const auto& [node, vector] : vectors)
    if ((vector - vector.dot(normal) * normal).norm() > sameDirection * longest.norm())
      throw InputError(
          "row " + std::to_string(row) +
          " of contact acts on its nodes along more than one direction; give its rows of friction "
          "yourself.");
  return normal;
}

} // namespace

std::array<Eigen::Vector3d, 2> tangentsOf(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d z(0, 0, 1);
  if (std::abs(normal[2]) < 1e-12) // also in the plane
    return {Eigen::Vector3d(-normal[1], normal[0], 0), z};
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d first = normal.cross(Eigen::Vector3d::Unit(least)).normalized();
  return {first, normal.cross(first)};
}

FrictionRows frictionAlong(const ConstraintMatrix& contact, int components) {
  const CrsMatrix& rows = *contact.rows;
  const GlobalOrdinal numTangents = components - 1;
  FrictionRows result;
  std::vector<GlobalOrdinal> numbers;
  for (const GlobalOrdinal row : localIndices(*rows.getRowMap())) {
    result.contactRows.push_back(row);
    for (GlobalOrdinal k = 0; k < numTangents; ++k)
      numbers.push_back(numTangents * row + k);
  }
  const RCP<const Map> map = mapInOrder(numbers, rows.getComm());
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(map, components * rows.getGlobalMaxNumRowEntries()));
  collectively(*rows.getComm(), [&] {
    for (LocalOrdinal i = 0; i < std::ssize(result.contactRows); ++i) {
      const Vectors vectors = vectorsOf(rows, i, components);
      const Eigen::Vector3d normal = normalOf(vectors, result.contactRows[i]);
      for (GlobalOrdinal k = 0; k < numTangents; ++k)
        for (const auto& [node, vector] : vectors)
          for (int c = 0; c < components; ++c)
            if (const double value = vector.dot(normal) * tangentsOf(normal)[k][c]; value != 0)
              matrix->insertGlobalValues(numTangents * result.contactRows[i] + k,
                                         Teuchos::tuple<GlobalOrdinal>(node * components + c),
                                         Teuchos::tuple(value));
    }
  });
  matrix->fillComplete(rows.getDomainMap(), map);
  result.tangents = {matrix, rcp(new Vector(map))};
  return result;
}

} // namespace epafi::decomposition
