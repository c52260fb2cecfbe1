#include "PetscFile.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

namespace epafi::drivers {
namespace {

constexpr int matrixKind = 1211216, vectorKind = 1211214, indicesKind = 1211218;

template <class Number>
void writeBigEndian(std::span<const Number> values, std::ofstream& stream) {
  constexpr std::size_t portion = 65536; // numbers turned at a time
  std::vector<char> bytes;
  for (std::size_t begin = 0; begin < values.size(); begin += portion) {
    const auto some = values.subspan(begin, std::min(portion, values.size() - begin));
    bytes.resize(some.size_bytes());
    std::memcpy(bytes.data(), some.data(), bytes.size());
    if constexpr (std::endian::native == std::endian::little)
      for (std::size_t i = 0; i < bytes.size(); i += sizeof(Number))
        std::reverse(bytes.data() + i, bytes.data() + i + sizeof(Number));
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
}

} // namespace

PetscFile::PetscFile(const std::filesystem::path& file)
    : file_(file), stream_(file, std::ios::binary | std::ios::trunc) {
  if (!stream_)
    throw Error("the file '" + file.string() + "' cannot be made; is its folder there and writable?");
}

void PetscFile::write(const Eigen::SparseMatrix<double, Eigen::RowMajor, int>& matrix) {
  const std::size_t rows = matrix.rows();
  const std::size_t entries = matrix.nonZeros();
  std::vector<int> lengths(rows);
  for (std::size_t row = 0; row < rows; ++row)
    lengths[row] = matrix.outerIndexPtr()[row + 1] - matrix.outerIndexPtr()[row];
  integers(std::array{matrixKind, static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()),
                      static_cast<int>(entries)});
  integers(lengths);
  integers({matrix.innerIndexPtr(), entries});
  reals({matrix.valuePtr(), entries});
}

void PetscFile::write(std::span<const double> vector) {
  integers(std::array{vectorKind, static_cast<int>(vector.size())});
  reals(vector);
}

void PetscFile::write(std::span<const int> indices) {
  integers(std::array{indicesKind, static_cast<int>(indices.size())});
  integers(indices);
}

void PetscFile::close() {
  stream_.close();
  if (!stream_)
    throw Error("the file '" + file_.string() + "' could not be written in full; is there room?");
}

void PetscFile::integers(std::span<const int> values) {
  writeBigEndian(values, stream_);
}

void PetscFile::reals(std::span<const double> values) {
  writeBigEndian(values, stream_);
}

} // namespace epafi::drivers
