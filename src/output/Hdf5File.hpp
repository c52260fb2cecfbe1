#pragma once

/// One HDF5 file that all ranks write together.

#include "epafi/base/Slab.hpp"
#include "epafi/base/Types.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace epafi::output {

/// An HDF5 file that appears under its name only when `close` has succeeded; until then it has a temporary
/// name in the same directory. If the object is destroyed before that, the temporary is removed and an older
/// file stays as it was.
///
/// All methods, construction and destruction are collective over the communicator given, with the same
/// arguments on all ranks (slab ranges and values apart). Their errors are agreed on by all ranks, so that
/// all leave together. Code between the calls should keep to that rule: an exception on some ranks only
/// leaves the others waiting for them. Destruction by such an exception is not collective, so that it gets
/// out; HDF5 then keeps the nameless file until MPI ends. A rank may hold no rows. HDF5 itself leaves ranks
/// waiting for each other when one of them cannot write, so room for all that comes is reserved before HDF5
/// hears of it: a full disk is an error before anything is written. (A disk that breaks is not covered, nor
/// one whose file system cannot reserve.) The communicator must be an MPI one or a serial one in a program
/// that has initialised MPI.
class Hdf5File {
public:
  /// Opens the temporary.
  /// \param from  a file that it begins as a copy of, perhaps the older one of its name; empty: with nothing
  /// \throws InputError if the directory cannot be made or written to, Error if HDF5 refuses.
  Hdf5File(const std::filesystem::path& path, const RCP<const Comm>& comm,
           const std::filesystem::path& from = {});
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Makes a group and those above it that are missing. \throws Error (also if it is there already).
  void createGroup(const std::string& group);

  /// Writes a dataset of `rows` rows: two-dimensional, rows × columns, or one-dimensional if columns is 0.
  /// Each rank hands over its rows, row by row. Groups above it are made. T is double, int, long long or
  /// signed char. Precondition: the ranges of the ranks do not overlap; that they add up to `rows` is
  /// checked. \throws Error if a range does not fit, if the dataset is there already, or if writing fails.
  template <class T>
  void write(const std::string& dataset, GlobalOrdinal rows, int columns, const RowRange& range,
             std::span<const T> values);

  /// Gives a group or dataset that exists one more name, which another one may have had. \throws Error.
  void link(const std::string& name, const std::string& object);

  /// Takes away the names in a group but these; what has no other is gone. \throws Error.
  void removeAllBut(const std::string& group, const std::vector<std::string>& names);

  /// Attribute of a group or dataset that exists ("/" is the file itself); an older one of the name goes.
  /// \throws Error.
  void attribute(const std::string& object, const std::string& name, const std::string& value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, long long value);

  /// Completes the file, and returns the temporary name that it has; whoever calls it gives it the other one,
  /// or removes it. Nothing may be written afterwards. \throws Error; the file is not there then.
  std::filesystem::path complete();
  /// Completes the file and gives it its name. Nothing may be written afterwards. \throws Error; the file is
  /// not there then.
  void close();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
  using Identifier = std::int64_t; ///< HDF5's hid_t

  void writeAttribute(const std::string& object, const std::string& name, Identifier type, const void* value);
  void reserve(std::uintmax_t bytes);
  void flush();
  void abandon() noexcept;
  void forget() noexcept;
  template <class Work>
  void together(const Work& work);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  RCP<const Comm> comm_;
  Identifier file_ = -1;
  int exceptions_;              ///< under way when the file was opened
  bool hasFailed_ = false;      ///< whether the last method threw, on all ranks
  std::uintmax_t reserved_ = 0; ///< bytes of the file that the file system has promised
};

} // namespace epafi::output
