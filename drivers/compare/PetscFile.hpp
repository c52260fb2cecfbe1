#pragma once

/// Matrices and vectors in PETSc's binary format, as `MatLoad`, `VecLoad` and `ISLoad` read them one after
/// the other: big-endian 32-bit integers and 64-bit reals.
///
///   matrix   1211216, rows, columns, entries, entries of each row, columns of the entries, entries
///   vector   1211214, length, values
///   indices  1211218, length, values
///
/// Source: PETSc's manual pages of MatLoad, VecLoad and ISLoad.

#include <Eigen/SparseCore>

#include <filesystem>
#include <fstream>
#include <span>

namespace epafi::drivers {

class PetscFile {
public:
  /// Replaces the file. \throws Error if it cannot be made.
  explicit PetscFile(const std::filesystem::path& file);

  /// Precondition: compressed.
  void write(const Eigen::SparseMatrix<double, Eigen::RowMajor, int>& matrix);
  void write(std::span<const double> vector);
  void write(std::span<const int> indices);
  /// \throws Error if anything could not be written.
  void close();

private:
  void integers(std::span<const int> values);
  void reals(std::span<const double> values);

  std::filesystem::path file_;
  std::ofstream stream_;
};

} // namespace epafi::drivers
