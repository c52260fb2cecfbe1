#include "epafi/output/Checkpoint.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/CheckpointHeader.hpp"
#include "epafi/output/Slab.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

namespace epafi::output {
namespace {

namespace fs = std::filesystem;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::size_t sizeOfShare(GlobalOrdinal rows, int rank, const Comm& comm) {
  return static_cast<std::size_t>(evenShare(rows, rank, comm.getSize()).count);
}

/// A checkpoint that is being written: remembers the first failure, so that shares can be taken on all the same.
class Writer {
public:
  explicit Writer(const fs::path& temporary) : file_(std::fopen(temporary.c_str(), "wb"), std::fclose) {
    note(file_ != nullptr);
  }
  void add(const void* bytes, std::size_t size) {
    if (size == 0)
      return; // `bytes` may be null then
    checksum_.add(bytes, size);
    if (error_ == 0)
      note(std::fwrite(bytes, 1, size, file_.get()) == size);
  }
  /// 0, or the error number of what failed first.
  int finish() {
    const std::uint64_t checksum = checksum_.value();
    add(&checksum, sizeof checksum);
    if (error_ == 0)
      note(std::fflush(file_.get()) == 0 && ::fsync(::fileno(file_.get())) == 0);
    if (file_ != nullptr && std::fclose(file_.release()) != 0)
      note(false);
    return error_;
  }

private:
  void note(bool succeeded) {
    if (!succeeded && error_ == 0)
      error_ = errno != 0 ? errno : EIO;
  }
  File file_;
  Checksum checksum_;
  int error_ = 0;
};

/// Rank 0 writes the shares as they come. Returns 0 or an error number; 0 on the others. Collective.
int writeShares(const fs::path& temporary, const Fingerprint& fingerprint, std::span<const double> share,
                const Comm& comm) {
  const auto size = static_cast<int>(share.size());
  if (comm.getRank() > 0) {
    Teuchos::send(comm, size, share.data(), 0);
    return 0;
  }
  errno = 0;
  Writer writer(temporary);
  const std::string header = checkpointHeader(fingerprint);
  writer.add(header.data(), header.size());
  writer.add(share.data(), share.size_bytes());
  std::vector<double> received(share.size()); // rank 0 has the longest
  for (int rank = 1; rank < comm.getSize(); ++rank) {
    const std::size_t count = sizeOfShare(fingerprint.numMultipliers(), rank, comm);
    Teuchos::receive(comm, rank, static_cast<int>(count), received.data());
    writer.add(received.data(), count * sizeof(double));
  }
  return writer.finish();
}

/// A checkpoint that is being read, on rank 0.
class Reader {
public:
  explicit Reader(const fs::path& path) : file_(nullptr, std::fclose) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
      throw InputError("does not exist");
    if (!fs::is_regular_file(status))
      throw InputError("is no regular file");
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_)
      throw InputError(std::string("cannot be opened: ") + std::strerror(errno));
    readHeader(fs::file_size(path, error));
  }
  [[nodiscard]] const Fingerprint& fingerprint() const { return header_.fingerprint; }

  void take(std::span<double> values) {
    take(values.data(), values.size_bytes());
    checksum_.add(values.data(), values.size_bytes());
    if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
      throw InputError("holds a number that is not finite");
  }
  void finish() {
    std::uint64_t stored = 0;
    take(&stored, sizeof stored);
    if (stored != checksum_.value())
      throw InputError("is damaged: its checksum is wrong");
  }

private:
  void readHeader(std::uintmax_t size) {
    std::string text(longestCheckpointHeader, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file_.get()));
    header_ = parseCheckpointHeader(text);
    const auto expected = header_.length + sizeof(std::uint64_t) +
                          sizeof(double) * static_cast<std::uintmax_t>(header_.fingerprint.numMultipliers());
    if (size != expected)
      throw InputError("has " + std::to_string(size) + " bytes instead of " + std::to_string(expected) +
                       (size < expected ? ": it is cut off" : ": something was added to it"));
    checksum_.add(text.data(), header_.length);
    if (std::fseek(file_.get(), static_cast<long>(header_.length), SEEK_SET) != 0)
      throw InputError("cannot be read");
  }
  void take(void* bytes, std::size_t size) {
    if (std::fread(bytes, 1, size, file_.get()) != size)
      throw InputError("cannot be read to its end");
  }

  File file_;
  ParsedHeader header_;
  Checksum checksum_;
};

/// Runs `work`; what it refuses gets the file's name before it and what to do behind it.
template <class Work>
void about(const fs::path& file, const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    throw InputError("the checkpoint '" + file.string() + "' " + error.what() +
                     "; name the checkpoint of a run of this scene, or start without one");
  }
}

/// Rank 0 passes the shares on, whatever they are worth: the verdict comes at the end. Collective.
std::string passShares(Reader* reader, const Fingerprint& fingerprint, std::vector<double>& share,
                       const Comm& comm) {
  if (comm.getRank() > 0) {
    Teuchos::receive(comm, 0, static_cast<int>(share.size()), share.data());
    return {};
  }
  std::string verdict;
  const auto take = [&](std::span<double> values) {
    try {
      if (verdict.empty())
        reader->take(values);
    } catch (const InputError& error) {
      verdict = error.what();
    }
  };
  take(share);
  std::vector<double> next(share.size()); // rank 0 has the longest
  for (int rank = 1; rank < comm.getSize(); ++rank) {
    next.resize(sizeOfShare(fingerprint.numMultipliers(), rank, comm));
    take(next);
    Teuchos::send(comm, static_cast<int>(next.size()), next.data(), rank);
  }
  return verdict;
}

} // namespace

void writeCheckpoint(const fs::path& file, const Fingerprint& fingerprint, const Vector& lambda) {
  const RCP<const Comm> comm = lambda.getMap()->getComm();
  prepareTarget(file, *comm);
  const fs::path temporary = temporaryBeside(file, *comm);
  const RCP<const Map> shares = slabMap(fingerprint.numMultipliers(), comm);
  Vector ordered(shares);
  ordered.doImport(lambda, Import(lambda.getMap(), shares), Tpetra::INSERT);
  const auto values = ordered.getData();
  const int error = writeShares(temporary, fingerprint,
                                {values.getRawPtr(), static_cast<std::size_t>(values.size())}, *comm);
  collectively(*comm, [&] {
    if (error == 0)
      return;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error("File '" + file.string() + "' could not be written: " + std::strerror(error) +
                ". Check the free space and the permissions of its directory.");
  });
  publish(temporary, file, *comm);
}

Checkpoint readCheckpoint(const fs::path& file, const Comm& comm) {
  Checkpoint checkpoint;
  checkpoint.file = file;
  std::unique_ptr<Reader> reader;
  collectively(comm, [&] {
    about(file, [&] {
      if (comm.getRank() == 0)
        reader = std::make_unique<Reader>(file);
    });
  });
  if (reader)
    checkpoint.fingerprint = reader->fingerprint();
  Teuchos::broadcast(comm, 0, static_cast<int>(sizeof(Fingerprint)),
                     reinterpret_cast<char*>(&checkpoint.fingerprint));
  collectively(comm, [&] {
    checkpoint.share.resize(sizeOfShare(checkpoint.fingerprint.numMultipliers(), comm.getRank(), comm));
  });
  std::string verdict = passShares(reader.get(), checkpoint.fingerprint, checkpoint.share, comm);
  collectively(comm, [&] {
    about(file, [&] {
      if (!verdict.empty())
        throw InputError(verdict);
      if (reader)
        reader->finish();
    });
  });
  return checkpoint;
}

RCP<Vector> multipliersOf(const Checkpoint& checkpoint, const decomposition::DecomposedProblem& problem,
                          const Fingerprint& fingerprint) {
  collectively(*problem.comm, [&] {
    about(checkpoint.file, [&] {
      if (const std::string difference = differenceBetween(fingerprint, checkpoint.fingerprint);
          !difference.empty())
        throw InputError("belongs to another problem: it " + difference);
    });
  });
  const RCP<const Map> shares = slabMap(fingerprint.numMultipliers(), problem.comm);
  Vector ordered(shares);
  std::copy(checkpoint.share.begin(), checkpoint.share.end(), ordered.getDataNonConst().begin());
  const RCP<Vector> lambda = rcp(new Vector(problem.multiplierMap));
  lambda->doImport(ordered, Import(shares, problem.multiplierMap), Tpetra::INSERT);
  return lambda;
}

} // namespace epafi::output
