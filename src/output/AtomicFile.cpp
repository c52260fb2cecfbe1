#include "epafi/output/AtomicFile.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_Comm.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

namespace epafi::output {
namespace {

namespace fs = std::filesystem;

fs::path directoryOf(const fs::path& file) {
  const fs::path parent = file.parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

/// A hidden name beside the file that no other run uses; what a killed run leaves bears such a name.
fs::path partialBeside(const fs::path& file) {
  std::ostringstream name;
  name << '.' << file.filename().string() << '.' << std::hex << std::random_device{}() << ".partial";
  return directoryOf(file) / name.str();
}

void prepareOnThisRank(const fs::path& file) {
  const fs::path directory = directoryOf(file);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error || !fs::is_directory(directory))
    throw InputError("Output directory '" + directory.string() + "' cannot be created: " +
                     (error ? error.message() : std::string("a file of that name is in the way")) +
                     ". Name a directory that can be written to.");
  if (fs::is_directory(file, error))
    throw InputError("Output file '" + file.string() + "' is a directory. Remove it or choose another name.");
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw InputError("Output file '" + file.string() + "' is a device or a pipe. Choose another name.");
  const fs::path probe = partialBeside(file); // permissions do not tell all
  errno = 0;
  const bool isWritable = std::ofstream(probe).is_open();
  const int reason = errno;
  fs::remove(probe, error);
  if (!isWritable)
    throw InputError("Output directory '" + directory.string() + "' cannot be written to: " +
                     std::strerror(reason) + ". Name a directory that can be written to.");
}

/// \param called  how errors call the file
void writeOnThisRank(const fs::path& file, const std::string& text, const fs::path& called, bool syncs) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  int reason = stream ? 0 : errno;
  if (stream && syncs) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    reason = descriptor >= 0 && ::fsync(descriptor) == 0 ? 0 : errno;
    if (descriptor >= 0)
      ::close(descriptor);
  }
  if (reason != 0)
    throw Error("File '" + called.string() + "' could not be written: " + std::strerror(reason) +
                ". Check the free space and the permissions of its directory.");
}

void copyOnThisRank(const fs::path& from, const fs::path& temporary) {
  std::error_code error;
  fs::copy_file(from, temporary, error);
  if (error)
    throw Error("File '" + from.string() + "' could not be copied, to go on with it: " + error.message() +
                ". Check the free space, and that nobody has removed it.");
}

/// 0, or the error number.
int reserveOnThisRank(const fs::path& file, std::uintmax_t bytes) {
#ifdef __linux__
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0)
    return errno;
  int result = 0;
  do
    result = ::fallocate(descriptor, 0, 0, bytes) == 0 ? 0 : errno;
  while (result == EINTR);
  ::close(descriptor);
  return result == EOPNOTSUPP || result == ENOSYS ? 0 : result;
#else
  static_cast<void>(file);
  static_cast<void>(bytes);
  return 0;
#endif
}

} // namespace

void prepareTarget(const fs::path& file, const Comm& comm) {
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      prepareOnThisRank(file);
  });
}

fs::path temporaryBeside(const fs::path& file, const Comm& comm) {
  std::string path;
  collectively(comm, [&] {
    if (comm.getRank() > 0)
      return;
    path = fs::absolute(partialBeside(file)).string(); // others may work in another directory
  });
  return agreedText(comm, path);
}

void removeTemporary(const fs::path& temporary) noexcept try {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  const std::string name = temporary.filename().string() + '-';
  for (const fs::directory_entry& entry : fs::directory_iterator(temporary.parent_path(), ignored))
    if (entry.path().filename().string().starts_with(name))
      fs::remove(entry.path(), ignored);
} catch (...) {
  // A hidden file stays.
}

void createForAll(const fs::path& temporary, const Comm& comm, const fs::path& from) {
  collectively(comm, [&] {
    if (comm.getRank() > 0)
      return;
    if (from.empty())
      writeOnThisRank(temporary, "", temporary, false);
    else
      copyOnThisRank(from, temporary);
  });
  collectively(comm, [&] {
    std::error_code error;
    if (!fs::exists(temporary, error))
      throw InputError("Rank " + std::to_string(comm.getRank()) +
                       " does not see the files that rank 0 makes in '" + directoryOf(temporary).string() +
                       "'. Name a directory that all machines of the run share.");
  });
}

void reserveSpace(const fs::path& temporary, std::uintmax_t bytes, const fs::path& file, const Comm& comm) {
  collectively(comm, [&] {
    const int error = comm.getRank() == 0 ? reserveOnThisRank(temporary, bytes) : 0;
    if (error != 0)
      throw Error("There is no room for the " + std::to_string(bytes) + " bytes of '" + file.string() +
                  "': " + std::strerror(error) + ". Free some space or choose another directory.");
  });
}

void publish(const fs::path& temporary, const fs::path& file, const Comm& comm) {
  collectively(comm, [&] {
    if (comm.getRank() != 0)
      return;
    std::error_code error;
    fs::rename(temporary, file, error);
    if (!error)
      return;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error("File '" + file.string() + "' could not be put in place: " + error.message() + ".");
  });
}

fs::path writeTemporary(const fs::path& file, const std::function<std::string()>& text, bool syncs,
                        const Comm& comm) {
  prepareTarget(file, comm);
  fs::path temporary = temporaryBeside(file, comm);
  collectively(comm, [&] {
    if (comm.getRank() != 0)
      return;
    try {
      writeOnThisRank(temporary, text(), file, syncs);
    } catch (...) {
      std::error_code ignored;
      fs::remove(temporary, ignored);
      throw;
    }
  });
  return temporary;
}

void writeTextFile(const fs::path& file, const std::function<std::string()>& text, const Comm& comm) {
  publish(writeTemporary(file, text, true, comm), file, comm);
}

} // namespace epafi::output
