#pragma once

#include <hdf5.h>

#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace epafi::test {

/// A dataset as plain numbers, whatever their type in the file.
struct Table {
  std::vector<std::size_t> extent;
  std::vector<double> values;
};

/// Opens a file for one rank alone.
inline hid_t openAlone(const std::filesystem::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
    throw std::runtime_error("cannot open " + path.string());
  return file;
}

inline Table readTable(const std::filesystem::path& path, const std::string& dataset) {
  const hid_t file = openAlone(path);
  const hid_t data = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(data);
  hsize_t extent[2] = {0, 1};
  const int rank = H5Sget_simple_extent_dims(space, extent, nullptr);
  Table table{{extent, extent + rank}, std::vector<double>(extent[0] * extent[1])};
  H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.values.data());
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  return table;
}

inline std::string readText(const std::filesystem::path& path, const std::string& object,
                            const std::string& name) {
  const hid_t file = openAlone(path);
  const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  std::vector<char> text(H5Tget_size(type) + 1, '\0');
  H5Aread(attribute, type, text.data());
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(file);
  return text.data();
}

} // namespace epafi::test
