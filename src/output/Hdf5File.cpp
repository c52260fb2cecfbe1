#include "epafi/output/Hdf5File.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/RawCommunicator.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/internal/Hdf5Handle.hpp"

#include <hdf5.h>

#include <algorithm>
#include <exception>
#include <type_traits>
#include <utility>

namespace epafi::output {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>, "Hdf5File stores HDF5's identifiers as std::int64_t");

/// Room for what HDF5 writes beside the tables: a few times what an empty file, and a group, dataset or
/// attribute take.
constexpr std::uintmax_t bytesOfFile = 16384;
constexpr std::uintmax_t bytesOfObject = 2048;

/// Descriptions on HDF5's error stack: what its call failed to do, and the innermost cause.
std::string hdf5Reason() {
  std::pair<std::string, std::string> ends;
  const auto collect = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    auto& [outer, inner] = *static_cast<std::pair<std::string, std::string>*>(data);
    inner = error->desc != nullptr ? error->desc : "";
    if (outer.empty())
      outer = inner;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, collect, &ends);
  if (ends.first.empty())
    return "HDF5 gives no reason";
  return ends.first == ends.second ? ends.first : ends.first + " (" + ends.second + ")";
}

/// `result` if it is no HDF5 error; works for identifiers and return codes. Words are put together after HDF5
/// has failed, never before it is called: a rank without memory for them would stay behind, and HDF5 with the
/// others wait.
template <class Result>
Result checked(Result result, const std::filesystem::path& file, const char* what,
               const std::string& name = {}) {
  if (result < 0)
    throw Error("File '" + file.string() + "': " + what + (name.empty() ? "" : " '" + name + "'") +
                " failed: " + hdf5Reason() + ".");
  return result;
}

template <class T>
hid_t memoryType() {
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, int>)
    return H5T_NATIVE_INT;
  else if constexpr (std::is_same_v<T, long long>)
    return H5T_NATIVE_LLONG;
  else
    return H5T_NATIVE_SCHAR;
}

/// Room for an object and for the groups above it that may have to be made.
std::uintmax_t bytesOfPath(const std::string& path) {
  return bytesOfObject * (1 + std::count(path.begin(), path.end(), '/'));
}

hid_t openFile(const std::filesystem::path& temporary, bool isCopy, MPI_Comm comm) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL), temporary, "choosing parallel access");
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
#if H5_VERSION_GE(1, 10, 7)
  // The temporary is ours alone, and some file systems know no locks.
  H5Pset_file_locking(access, false, true);
#endif
  if (isCopy)
    return checked(H5Fopen(temporary.c_str(), H5F_ACC_RDWR, access), temporary, "opening it");
  return checked(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), temporary, "creating it");
}

/// Names in a group.
std::vector<std::string> linksOf(hid_t file, const std::filesystem::path& path, const std::string& group) {
  const Handle opened(checked(H5Gopen2(file, group.c_str(), H5P_DEFAULT), path, "opening group", group),
                      H5Gclose);
  H5G_info_t info{};
  checked(H5Gget_info(opened, &info), path, "looking into group", group);
  std::vector<std::string> names;
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    const auto get = [&](char* text, std::size_t size) {
      return checked(H5Lget_name_by_idx(opened, ".", H5_INDEX_NAME, H5_ITER_INC, k, text, size, H5P_DEFAULT),
                     path, "looking into group", group);
    };
    std::string name(get(nullptr, 0), '\0');
    get(name.data(), name.size() + 1);
    names.push_back(std::move(name));
  }
  return names;
}

hid_t createDataset(hid_t file, const std::filesystem::path& path, const std::string& name, hid_t type,
                    GlobalOrdinal rows, int columns) {
  const hsize_t extent[2] = {static_cast<hsize_t>(rows), static_cast<hsize_t>(columns)};
  const Handle space(H5Screate_simple(columns == 0 ? 1 : 2, extent, nullptr), H5Sclose);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links, 1);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER); // every row is written
  return checked(H5Dcreate2(file, name.c_str(), type, space, links, creation, H5P_DEFAULT), path,
                 "making dataset", name);
}

void writeRows(hid_t dataset, const std::filesystem::path& path, const std::string& name, hid_t type,
               int columns, const RowRange& range, const void* values) {
  const int rank = columns == 0 ? 1 : 2;
  const hsize_t start[2] = {static_cast<hsize_t>(range.first), 0};
  const hsize_t count[2] = {static_cast<hsize_t>(range.count), static_cast<hsize_t>(columns)};
  const Handle fileSpace(H5Dget_space(dataset), H5Sclose);
  const Handle memorySpace(H5Screate_simple(rank, count, nullptr), H5Sclose);
  if (range.count == 0) {
    H5Sselect_none(fileSpace);
    H5Sselect_none(memorySpace);
  } else {
    H5Sselect_hyperslab(fileSpace, H5S_SELECT_SET, start, nullptr, count, nullptr);
  }
  const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  const double nothing = 0; // HDF5 wants an address even of no rows
  const void* source = range.count == 0 ? &nothing : values;
  checked(H5Dwrite(dataset, type, memorySpace, fileSpace, transfer, source), path, "writing dataset", name);
}

} // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path, const RCP<const Comm>& comm,
                   const std::filesystem::path& from)
    : path_(path), comm_(comm), exceptions_(std::uncaught_exceptions()) {
  prepareTarget(path, *comm);
  temporary_ = temporaryBeside(path, *comm);
  const QuietHdf5 quiet;
  try {
    // HDF5 would wait for a rank that cannot open it.
    createForAll(temporary_, *comm, from);
    collectively(*comm, [&] {
      reserved_ = std::filesystem::file_size(temporary_);
      file_ =
          openFile(temporary_, !from.empty(), comm->getSize() > 1 ? rawCommunicator(*comm) : MPI_COMM_SELF);
    });
    reserve(bytesOfFile);
  } catch (const Error&) {
    abandon();
    throw;
  } catch (...) {
    forget();
    throw;
  }
}

Hdf5File::~Hdf5File() {
  if (file_ < 0)
    return;
  if (std::uncaught_exceptions() > exceptions_ && !hasFailed_) // on this rank alone, perhaps
    forget();
  else
    abandon();
}

void Hdf5File::forget() noexcept {
  file_ = -1;
  removeTemporary(temporary_);
}

/// Runs `work`, and remembers whether it threw what all ranks agree on: an Error of ours, nothing else.
template <class Work>
void Hdf5File::together(const Work& work) {
  hasFailed_ = false;
  try {
    if (file_ < 0)
      throw Error("File '" + path_.string() + "' is closed already.");
    work();
  } catch (const Error&) {
    hasFailed_ = true;
    throw;
  }
}

void Hdf5File::reserve(std::uintmax_t bytes) {
  reserveSpace(temporary_, reserved_ + bytes, path_, *comm_);
  reserved_ += bytes;
}

void Hdf5File::flush() {
  collectively(*comm_, [&] { checked(H5Fflush(file_, H5F_SCOPE_LOCAL), path_, "completing it"); });
}

void Hdf5File::abandon() noexcept {
  const QuietHdf5 quiet;
  if (file_ >= 0) {
    try {
      flush();
      H5Fclose(file_);
    } catch (...) {
      // H5Fclose would fail too and leave an identifier of freed memory, which HDF5 would close once more at
      // the end of MPI. So HDF5 keeps the file until then; it has no name any more.
    }
  }
  file_ = -1;
  if (comm_->getRank() == 0)
    removeTemporary(temporary_);
}

void Hdf5File::createGroup(const std::string& group) {
  together([&] {
    reserve(bytesOfPath(group));
    const QuietHdf5 quiet;
    collectively(*comm_, [&] {
      const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
      H5Pset_create_intermediate_group(links, 1);
      const Handle made(H5Gcreate2(file_, group.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
      checked<hid_t>(made, path_, "making group", group);
    });
  });
}

template <class T>
void Hdf5File::write(const std::string& dataset, GlobalOrdinal rows, int columns, const RowRange& range,
                     std::span<const T> values) {
  together([&] {
    const GlobalOrdinal written = sumOverRanks(*comm_, range.count);
    collectively(*comm_, [&] {
      const std::size_t expected = range.count * (columns == 0 ? 1 : columns);
      if (columns < 0 || range.first < 0 || range.count < 0 || range.first + range.count > rows ||
          values.size() != expected || written != rows)
        throw Error("File '" + path_.string() + "', dataset '" + dataset + "': rank " +
                    std::to_string(comm_->getRank()) + " hands over " + std::to_string(values.size()) +
                    " values for rows " + std::to_string(range.first) + " to " +
                    std::to_string(range.first + range.count) + " of " + std::to_string(rows) + " × " +
                    std::to_string(columns) + ", and all ranks together " + std::to_string(written) +
                    " rows.");
    });
    const int width = columns == 0 ? 1 : columns;
    reserve(sizeof(T) * rows * width + bytesOfPath(dataset));
    const QuietHdf5 quiet;
    hid_t id = -1;
    collectively(*comm_, [&] { id = createDataset(file_, path_, dataset, memoryType<T>(), rows, columns); });
    const Handle owned(id, H5Dclose);
    collectively(*comm_, [&] {
      if (rows > 0)
        writeRows(id, path_, dataset, memoryType<T>(), columns, range, values.data());
    });
  });
}

template void Hdf5File::write(const std::string&, GlobalOrdinal, int, const RowRange&,
                              std::span<const double>);
template void Hdf5File::write(const std::string&, GlobalOrdinal, int, const RowRange&, std::span<const int>);
template void Hdf5File::write(const std::string&, GlobalOrdinal, int, const RowRange&,
                              std::span<const long long>);
template void Hdf5File::write(const std::string&, GlobalOrdinal, int, const RowRange&,
                              std::span<const signed char>);

void Hdf5File::link(const std::string& name, const std::string& object) {
  together([&] {
    reserve(bytesOfPath(name));
    const QuietHdf5 quiet;
    collectively(*comm_, [&] {
      if (H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0)
        checked(H5Ldelete(file_, name.c_str(), H5P_DEFAULT), path_, "taking away the name", name);
      checked(H5Lcreate_hard(file_, object.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), path_,
              "giving the name", name);
    });
  });
}

void Hdf5File::removeAllBut(const std::string& group, const std::vector<std::string>& names) {
  together([&] {
    const QuietHdf5 quiet;
    collectively(*comm_, [&] {
      for (const std::string& name : linksOf(file_, path_, group))
        if (std::find(names.begin(), names.end(), name) == names.end())
          checked(H5Ldelete(file_, (group + '/' + name).c_str(), H5P_DEFAULT), path_, "taking away the name",
                  name);
    });
  });
}

void Hdf5File::writeAttribute(const std::string& object, const std::string& name, Identifier type,
                              const void* value) {
  together([&] {
    reserve(bytesOfObject + H5Tget_size(type));
    collectively(*comm_, [&] {
      if (H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0)
        checked(H5Adelete_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT), path_,
                "removing attribute", name);
      const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
      const Handle made(H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                          H5P_DEFAULT, H5P_DEFAULT),
                        H5Aclose);
      checked<hid_t>(made, path_, "making attribute", name);
      checked(H5Awrite(made, type, value), path_, "writing attribute", name);
    });
  });
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& value) {
  const QuietHdf5 quiet;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, value.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  writeAttribute(object, name, type, value.c_str());
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  const QuietHdf5 quiet;
  writeAttribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5File::attribute(const std::string& object, const std::string& name, long long value) {
  const QuietHdf5 quiet;
  writeAttribute(object, name, H5T_NATIVE_LLONG, &value);
}

std::filesystem::path Hdf5File::complete() {
  const QuietHdf5 quiet;
  together([&] {
    try {
      flush();
      collectively(*comm_, [&] { checked(H5Fclose(std::exchange(file_, -1)), path_, "closing it"); });
    } catch (const Error&) {
      abandon();
      throw;
    }
  });
  return temporary_;
}

void Hdf5File::close() {
  publish(complete(), path_, *comm_);
}

} // namespace epafi::output
