#include "epafi/decomposition/SubdomainMatrix.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace epafi::decomposition {
namespace {

/// What K^s and its transpose may differ by, relative to its largest entry: far above round-off of an
/// assembly.
constexpr double asymmetry = 1e-10;

std::string sizeOf(Eigen::Index rows, Eigen::Index columns) {
  return std::to_string(rows) + " x " + std::to_string(columns);
}

double largestEntry(const SparseMatrix& matrix) {
  double largest = 0;
  for (Eigen::Index k = 0; k < matrix.nonZeros(); ++k)
    largest = std::max(largest, std::abs(matrix.valuePtr()[k]));
  return largest;
}

void requireShape(const Eigen::MatrixXd& array, Eigen::Index rows, Eigen::Index columns,
                  const std::string& what) {
  if (array.rows() != rows || array.cols() != columns)
    throw InputError(what + " is " + sizeOf(array.rows(), array.cols()) + ", but must be " +
                     sizeOf(rows, columns) + ", a row for each unknown.");
}

void requireUnknowns(const SubdomainMatrix& matrix, const std::string& where) {
  std::vector<GlobalOrdinal> unknowns = matrix.unknowns;
  std::sort(unknowns.begin(), unknowns.end());
  if (!unknowns.empty() && unknowns.front() < 0)
    throw InputError(where + " has an unknown of number " + std::to_string(unknowns.front()) +
                     "; numbers begin at 0.");
  if (const auto twice = std::adjacent_find(unknowns.begin(), unknowns.end()); twice != unknowns.end())
    throw InputError(where + " lists unknown " + std::to_string(*twice) + " twice.");
  for (const auto& [unknown, value] : matrix.prescribed)
    if (!std::binary_search(unknowns.begin(), unknowns.end(), unknown) || !std::isfinite(value))
      throw InputError(where + " prescribes the value " + std::to_string(value) + " for unknown " +
                       std::to_string(unknown) +
                       "; values must be finite, and of unknowns of the subdomain.");
}

} // namespace

SparseMatrix fromCompressedRows(std::span<const int> starts, std::span<const int> columns,
                                std::span<const double> values) {
  const int n = static_cast<int>(starts.size()) - 1;
  if (n < 0 || starts.front() != 0 || !std::is_sorted(starts.begin(), starts.end()) ||
      starts.back() != std::ssize(columns) || columns.size() != values.size())
    throw InputError(
        "compressed rows must start at 0, ascend, and end at the number of columns and values (" +
        std::to_string(columns.size()) + " and " + std::to_string(values.size()) + ").");
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(values.size());
  for (int row = 0; row < n; ++row)
    for (int k = starts[row]; k < starts[row + 1]; ++k) {
      if (columns[k] < 0 || columns[k] >= n)
        throw InputError("row " + std::to_string(row) + " of a matrix of " + std::to_string(n) +
                         " compressed rows has an entry in column " + std::to_string(columns[k]) + ".");
      entries.emplace_back(row, columns[k], values[k]);
    }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SubdomainMatrix subdomainMatrix(const CrsMatrix& local) {
  const Map& rows = *local.getRowMap();
  if (rows.getComm()->getSize() > 1)
    throw InputError("the stiffness of a subdomain must be a matrix on a communicator of one rank, not of " +
                     std::to_string(rows.getComm()->getSize()) +
                     "; make its maps with Teuchos::SerialComm or MPI_COMM_SELF.");
  if (!local.isFillComplete())
    throw InputError("the stiffness of a subdomain must be fill-complete; call fillComplete first.");
  SubdomainMatrix result;
  const auto n = static_cast<LocalOrdinal>(numLocal(rows));
  std::vector<Eigen::Triplet<double>> entries;
  typename CrsMatrix::local_inds_host_view_type columns;
  typename CrsMatrix::values_host_view_type values;
  for (LocalOrdinal row = 0; row < n; ++row) {
    result.unknowns.push_back(rows.getGlobalElement(row));
    local.getLocalRowView(row, columns, values);
    for (std::size_t k = 0; k < columns.extent(0); ++k) {
      const GlobalOrdinal column = local.getColMap()->getGlobalElement(columns(k));
      const LocalOrdinal place = rows.getLocalElement(column);
      if (place < 0 || place >= n)
        throw InputError("the stiffness of a subdomain has an entry in column " + std::to_string(column) +
                         ", which is none of its rows.");
      entries.emplace_back(row, place, values(k));
    }
  }
  result.stiffness.resize(n, n);
  result.stiffness.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Point pointAt(const Eigen::MatrixXd& coordinates, Eigen::Index row) {
  Point point{};
  for (Eigen::Index c = 0; c < coordinates.cols(); ++c)
    point[c] = coordinates(row, c);
  return point;
}

void requireSound(const SubdomainMatrix& matrix, int dimension, int components, int numBodies,
                  const std::string& where) {
  const Eigen::Index n = matrix.unknowns.size();
  if (matrix.body < 0 || matrix.body >= numBodies)
    throw InputError(where + " belongs to body " + std::to_string(matrix.body) + ", but there are " +
                     std::to_string(numBodies) + " bodies, counted from 0.");
  if (n == 0)
    throw InputError(where + " has no unknowns.");
  requireUnknowns(matrix, where);
  if (matrix.stiffness.rows() != n || matrix.stiffness.cols() != n)
    throw InputError("the stiffness of " + where + " is " +
                     sizeOf(matrix.stiffness.rows(), matrix.stiffness.cols()) + ", but it has " +
                     std::to_string(n) + " unknowns.");
  requireShape(matrix.load, n, 1, "the load of " + where);
  requireShape(matrix.coordinates, n, dimension, "the array of coordinates of " + where);
  if (matrix.nearKernel.size() > 0)
    requireShape(matrix.nearKernel, n, matrix.nearKernel.cols(), "the near-kernel of " + where);
  if (!matrix.coordinates.allFinite() || !matrix.nearKernel.allFinite())
    throw InputError("the coordinates or the near-kernel of " + where + " are not all finite.");
  if (!std::all_of(matrix.stiffness.valuePtr(), matrix.stiffness.valuePtr() + matrix.stiffness.nonZeros(),
                   [](double entry) { return std::isfinite(entry); }))
    throw InputError("the stiffness of " + where + " has an entry that is not a finite number.");
  for (const GlobalOrdinal node : matrix.crosspoints)
    if (std::none_of(matrix.unknowns.begin(), matrix.unknowns.end(),
                     [&](GlobalOrdinal unknown) { return unknown / components == node; }))
      throw InputError(where + " names node " + std::to_string(node) +
                       " a crosspoint, but has none of its unknowns.");
  const SparseMatrix difference = matrix.stiffness - SparseMatrix(matrix.stiffness.transpose());
  if (largestEntry(difference) > asymmetry * largestEntry(matrix.stiffness))
    throw InputError("the stiffness of " + where +
                     " is not symmetric; both triangles must be stored, equal to round-off.");
}

} // namespace epafi::decomposition
