#pragma once

/// Files that belong together.

#include "epafi/base/Types.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace epafi::output {

/// Files that are put in place together: all are complete under temporary names before the first gets its
/// own, and between the first and the last rank 0 does nothing but rename. Files get their names in the order
/// in which they were added, so that the last one says that the others are there. All methods are collective,
/// with the same arguments on all ranks.
class FileSet {
public:
  /// \param syncs  whether texts are to be on the disk then, not only on their way there; that takes a while
  explicit FileSet(RCP<const Comm> comm, bool syncs = true);
  /// Removes what was not put in place. Not collective.
  ~FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  /// What an older file of the name does: a file that means something only beside others (an XDMF beside its
  /// HDF5 file) must not be there when these are replaced, nor come where one of these does not.
  enum class Older { staysTillReplaced, goesFirst };

  /// `temporary`, which is complete, is to become `file`.
  void add(const std::filesystem::path& temporary, const std::filesystem::path& file,
           Older older = Older::staysTillReplaced);
  /// As writeTextFile, but for the name. \throws as that.
  void write(const std::filesystem::path& file, const std::function<std::string()>& text,
             Older older = Older::staysTillReplaced);
  /// Takes over the files of another set.
  void take(FileSet& other);
  /// Gives all files their names. \throws Error naming those that could not be put in place; the others are.
  void publish();

  [[nodiscard]] const Comm& comm() const { return *comm_; } ///< of the ranks that write
  /// Whether files are on the disk itself before they get their names.
  [[nodiscard]] bool syncs() const { return syncs_; }

private:
  struct Part {
    std::filesystem::path temporary, file;
    Older older;
  };

  RCP<const Comm> comm_;
  bool syncs_;
  std::vector<Part> parts_;
};

} // namespace epafi::output
