/// Any bytes as a checkpoint: as they are, and with the checksum that they would need, which gets them past
/// the last check but one. They are read, or refused in a sentence; nothing else may happen.

#include "Refusals.hpp"

#include "epafi/output/Checkpoint.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

namespace {

using namespace epafi;

/// A folder of its own for each process; it goes at the end.
class Folder {
public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("epafi-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string file() const { return (path_ / "run.checkpoint").string(); }

private:
  std::filesystem::path path_;
};

/// What is read is a whole checkpoint.
void requireSound(const output::Checkpoint& checkpoint) {
  bool isSound =
      static_cast<GlobalOrdinal>(checkpoint.values.size()) == checkpoint.fingerprint.numMultipliers();
  for (const double value : checkpoint.values)
    isSound = isSound && std::isfinite(value);
  if (!isSound) {
    std::cerr << "The checkpoint holds " << checkpoint.values.size() << " values, not all of them right.\n";
    std::abort();
  }
}

void read(const std::string& bytes) {
  static const Folder folder;
  static const Teuchos::SerialComm<int> comm;
  std::ofstream(folder.file(), std::ios::binary) << bytes;
  fuzz::orRefused([&] { requireSound(output::readCheckpoint(folder.file(), comm)); });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  read(bytes);
  output::Checksum checksum;
  checksum.add(data, size);
  const std::uint64_t value = checksum.value();
  read(bytes.append(reinterpret_cast<const char*>(&value), sizeof value));
  return 0;
}
