#include "epafi/output/FileSet.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/output/AtomicFile.hpp"

#include <Teuchos_Comm.hpp>

#include <system_error>
#include <utility>

namespace epafi::output {

namespace fs = std::filesystem;

FileSet::FileSet(RCP<const Comm> comm, bool syncs) : comm_(std::move(comm)), syncs_(syncs) {}

FileSet::~FileSet() {
  std::error_code ignored;
  if (comm_->getRank() == 0)
    for (const Part& part : parts_)
      fs::remove(part.temporary, ignored);
}

void FileSet::add(const fs::path& temporary, const fs::path& file, Older older) {
  parts_.push_back({temporary, file, older});
}

void FileSet::write(const fs::path& file, const std::function<std::string()>& text, Older older) {
  add(writeTemporary(file, text, syncs_, *comm_), file, older);
}

void FileSet::take(FileSet& other) {
  parts_.insert(parts_.end(), other.parts_.begin(), other.parts_.end());
  other.parts_.clear();
}

void FileSet::publish() {
  const std::vector<Part> parts = std::exchange(parts_, {});
  collectively(*comm_, [&] {
    if (comm_->getRank() != 0)
      return;
    std::string failures;
    std::error_code error, ignored;
    for (const Part& part : parts)
      if (part.older == Older::goesFirst)
        fs::remove(part.file, ignored);
    for (const Part& part : parts) {
      if (failures.empty() || part.older != Older::goesFirst)
        fs::rename(part.temporary, part.file, error);
      else
        error = std::make_error_code(std::errc::operation_canceled);
      if (!error)
        continue;
      failures += (failures.empty() ? "File '" : "; file '") + part.file.string() +
                  "' could not be put in place: " + error.message();
      fs::remove(part.temporary, ignored);
    }
    if (!failures.empty())
      throw Error(failures + ".");
  });
}

} // namespace epafi::output
