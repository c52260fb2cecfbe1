#pragma once

#include "epafi/base/Types.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>

namespace epafi::test {

/// An empty directory that all ranks know; it goes with the object. Construction and destruction are
/// collective.
class TemporaryDirectory {
public:
  explicit TemporaryDirectory(const RCP<const Comm>& comm) : comm_(comm) {
    int process = static_cast<int>(::getpid());
    Teuchos::broadcast(*comm, 0, 1, &process);
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("epafi-test-" + std::to_string(process) + "-" + std::to_string(++count));
    if (comm_->getRank() == 0)
      std::filesystem::create_directories(path_);
    comm_->barrier();
  }
  ~TemporaryDirectory() {
    comm_->barrier();
    if (comm_->getRank() == 0)
      std::filesystem::remove_all(path_);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Names of everything in it, hidden files too. Collective: what other ranks do before the call has
  /// happened.
  [[nodiscard]] std::set<std::string> content() const {
    comm_->barrier();
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.insert(entry.path().filename().string());
    comm_->barrier();
    return names;
  }

private:
  RCP<const Comm> comm_;
  std::filesystem::path path_;
};

} // namespace epafi::test
