#pragma once

/// Files that appear complete or not at all: written under a temporary name in their own directory, then
/// renamed.

#include "epafi/base/Types.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace epafi::output {

/// Makes sure that `file` can be written: creates its directory and those above it, and tries whether files
/// can be made there. Collective. \throws InputError naming the directory if it cannot be made or written to,
/// or if `file` is there and no regular file.
void prepareTarget(const std::filesystem::path& file, const Comm& comm);

/// A new name beside rank 0's `file` (same directory, hidden, ends in ".partial"), absolute and the same on
/// all ranks. Makes no file. Collective.
std::filesystem::path temporaryBeside(const std::filesystem::path& file, const Comm& comm);

/// Removes `temporary` and what MPI has made beside it (Open MPI's "<its name>-<job>-<process>.lock", which
/// stays where a file could not be closed). Says nothing of failures. Not collective.
void removeTemporary(const std::filesystem::path& temporary) noexcept;

/// Makes `temporary`, empty or a copy of rank 0's file `from`, for all ranks to open. Collective. \throws
/// InputError if a rank does not see it there, on a disk of its own perhaps; Error if it cannot be made.
void createForAll(const std::filesystem::path& temporary, const Comm& comm,
                  const std::filesystem::path& from = {});

/// Makes sure that the file system has room for the first `bytes` bytes of the file `temporary`, which
/// exists; the file grows to that size. Does nothing on file systems that cannot reserve. Collective (rank 0
/// does it). \throws Error naming `file`, which the temporary is to become, if there is no room.
void reserveSpace(const std::filesystem::path& temporary, std::uintmax_t bytes,
                  const std::filesystem::path& file, const Comm& comm);

/// Renames `temporary` to `file`, which replaces an older `file` in one step; removes `temporary` if that
/// fails. Collective. \throws Error naming the file.
void publish(const std::filesystem::path& temporary, const std::filesystem::path& file, const Comm& comm);

/// Writes what is to become `file`, a text or any bytes, under a temporary name, which it returns. As
/// writeTextFile.
/// \param syncs  whether it is on the disk then, not only on its way there
std::filesystem::path writeTemporary(const std::filesystem::path& file,
                                     const std::function<std::string()>& text, bool syncs, const Comm& comm);

/// Writes a text file (or any bytes) from rank 0, through prepareTarget, a temporary and publish. It is on
/// the disk then, not only on its way there.
///
/// \param text  makes the text; called on rank 0 only, must not call anything collective.
/// Collective.
/// \throws InputError (prepareTarget), Error if writing fails or `text` throws; then no file is left behind
///         and an older file of that name is untouched.
void writeTextFile(const std::filesystem::path& file, const std::function<std::string()>& text,
                   const Comm& comm);

} // namespace epafi::output
