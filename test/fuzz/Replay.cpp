/// Calls a fuzz target with the files of its corpus, one after the other: what a fuzzer found stays found,
/// whichever compiler builds it. Any exception that the target lets through, any crash and any hang fails.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

/// The files named, those in the folders named, in order.
std::set<fs::path> filesIn(int argc, char** argv) {
  std::set<fs::path> files;
  for (int i = 1; i < argc; ++i)
    if (!fs::is_directory(argv[i]))
      files.insert(argv[i]);
    else
      for (const fs::directory_entry& entry : fs::directory_iterator(argv[i]))
        files.insert(entry.path());
  return files;
}

} // namespace

int main(int argc, char** argv) {
  const std::set<fs::path> files = filesIn(argc, argv);
  for (const fs::path& file : files) {
    std::cout << file.string() << std::endl; // a crash comes right after its file's name
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) {
      std::cerr << file.string() << " cannot be read.\n";
      return 1;
    }
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  std::cout << files.size() << " files passed\n";
  return files.empty() ? 1 : 0;
}
