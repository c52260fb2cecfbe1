#include "epafi/output/AtomicFile.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_CommHelpers.hpp>

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

void prepareOnThisRank(const fs::path& file) {
  const fs::path directory = directoryOf(file);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error || !fs::is_directory(directory))
    throw InputError("Output directory '" + directory.string() + "' cannot be created: " +
                     (error ? error.message() : std::string("a file of that name is in the way")) +
                     ". Name a directory that can be written to.");
  if (::access(directory.c_str(), W_OK | X_OK) != 0)
    throw InputError("Output directory '" + directory.string() + "' cannot be written to: " +
                     std::strerror(errno) + ". Name a directory that can be written to.");
  if (fs::is_directory(file, error))
    throw InputError("Output file '" + file.string() + "' is a directory. Remove it or choose another name.");
}

void writeOnThisRank(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    throw Error("File '" + file.string() + "' could not be written: " + std::strerror(errno) +
                ". Check the free space and the permissions of its directory.");
}

} // namespace

void prepareTarget(const fs::path& file, const Comm& comm) {
  collectively(comm, [&] {
    if (comm.getRank() == 0)
      prepareOnThisRank(file);
  });
}

fs::path temporaryBeside(const fs::path& file, const Comm& comm) {
  int number = 0;
  if (comm.getRank() == 0)
    number = static_cast<int>(std::random_device{}() >> 1);
  Teuchos::broadcast(comm, 0, 1, &number);
  std::ostringstream name;
  name << '.' << file.filename().string() << '.' << std::hex << number << ".partial";
  return directoryOf(file) / name.str();
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

void writeTextFile(const fs::path& file, const std::function<std::string()>& text, const Comm& comm) {
  prepareTarget(file, comm);
  const fs::path temporary = temporaryBeside(file, comm);
  collectively(comm, [&] {
    if (comm.getRank() != 0)
      return;
    try {
      writeOnThisRank(temporary, text());
    } catch (...) {
      std::error_code ignored;
      fs::remove(temporary, ignored);
      throw;
    }
  });
  publish(temporary, file, comm);
}

} // namespace epafi::output
