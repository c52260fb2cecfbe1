#include "epafi/output/Checkpoint.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/output/AtomicFile.hpp"
#include "epafi/output/StepsText.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>
#include <utility>

namespace epafi::output {
namespace {

namespace fs = std::filesystem;

/// No header is longer.
constexpr std::size_t longestHeader = 1024;
constexpr std::string_view title = "Epafi checkpoint ";
constexpr std::string_view version = "4";
constexpr std::string_view order = std::endian::native == std::endian::little ? "little" : "big";

/// Counts in the order of the file.
constexpr std::array<std::pair<std::string_view, GlobalOrdinal Fingerprint::*>, 6> counts{
    {{"inequalities", &Fingerprint::numInequalities},
     {"equalities", &Fingerprint::numEqualities},
     {"primal", &Fingerprint::primalDimension},
     {"subdomains", &Fingerprint::numSubdomains},
     {"components", &Fingerprint::components},
     {"kernel", &Fingerprint::kernelDimension}}};

template <class Number, class... Form>
std::string textOf(Number value, Form... form) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, form...).ptr};
}

/// Line after line of a text.
class Lines {
public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// The rest of the next line, which begins with `name` and a blank.
  std::string_view valueOf(std::string_view name) {
    const std::string_view line = next();
    if (!line.starts_with(name) || line.substr(name.size()).substr(0, 1) != " ")
      refuse(name);
    return line.substr(name.size() + 1);
  }
  /// The number there, read to its end.
  template <class Number, class... Form>
  Number numberOf(std::string_view name, Form... form) {
    const std::string_view text = valueOf(name);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, form...);
    if (error != std::errc() || end != text.data() + text.size())
      refuse(name);
    return value;
  }
  std::string_view next() {
    const auto end = text_.find('\n', place_);
    if (end == std::string_view::npos)
      throw InputError("ends within its head");
    const std::string_view line = text_.substr(place_, end - place_);
    place_ = end + 1;
    return line;
  }
  [[nodiscard]] std::size_t place() const { return place_; }
  [[noreturn]] static void refuse(std::string_view name) {
    throw InputError("does not say '" + std::string(name) + "' where it should in its head");
  }

private:
  std::string_view text_;
  std::size_t place_ = 0;
};

struct Header {
  Fingerprint fingerprint;
  std::size_t steps = 0;  ///< bytes of what tells of load steps
  std::size_t length = 0; ///< of the text, the empty line included
};

/// Takes nothing but what checkpointHeader() writes, with any numbers. \param text  the beginning of a file
Header parsed(std::string_view text) {
  text = text.substr(0, longestHeader);
  if (!text.starts_with(title))
    throw InputError("is no checkpoint of Epafi");
  Lines lines(text.substr(title.size()));
  if (lines.next() != version)
    throw InputError("was written by another version of Epafi");
  if (lines.valueOf("order") != order)
    throw InputError("was written on a machine that stores numbers in another order");
  Header header;
  // So many that no sum or product of them overflows.
  constexpr GlobalOrdinal most = GlobalOrdinal{1} << 50;
  for (const auto& [name, member] : counts) {
    const auto value = lines.numberOf<GlobalOrdinal>(name);
    if (value < 0 || value > most)
      Lines::refuse(name);
    header.fingerprint.*member = value;
  }
  header.fingerprint.rows = lines.numberOf<std::uint64_t>("rows", 16);
  header.fingerprint.stiffness = lines.numberOf<double>("stiffness");
  if (!std::isfinite(header.fingerprint.stiffness))
    Lines::refuse("stiffness");
  header.steps = lines.numberOf<std::size_t>("steps");
  if (header.steps > std::size_t{most})
    Lines::refuse("steps");
  if (!lines.next().empty())
    throw InputError("has a head that does not end");
  header.length = title.size() + lines.place();
  return header;
}

/// What a file holds. \throws InputError that says what is wrong, without the file's name: "is no checkpoint
/// of Epafi".
Checkpoint readOnThisRank(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status))
    throw InputError("does not exist");
  if (!fs::is_regular_file(status))
    throw InputError("is no regular file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(std::string("cannot be opened: ") + std::strerror(errno));
  const auto take = [&stream](void* bytes, std::size_t size) -> std::size_t {
    stream.read(static_cast<char*>(bytes), size);
    return stream.gcount();
  };
  std::string text(longestHeader, '\0');
  text.resize(take(text.data(), text.size()));
  const Header header = parsed(text);
  std::uint64_t stored = 0;
  const auto expected =
      header.length + sizeof stored + header.steps + sizeof(double) * header.fingerprint.numMultipliers();
  if (const std::uintmax_t size = fs::file_size(file, error); size != expected)
    throw InputError("has " + std::to_string(size) + " bytes instead of " + std::to_string(expected) +
                     (size < expected ? ": it is cut off" : ": something was added to it"));
  Checkpoint checkpoint{file, header.fingerprint, {}, {}};
  std::vector<double>& values = checkpoint.values;
  values.resize(header.fingerprint.numMultipliers());
  stream.clear();
  stream.seekg(header.length);
  const std::size_t bytes = values.size() * sizeof(double);
  std::string steps(header.steps, '\0');
  if (take(values.data(), bytes) != bytes || take(steps.data(), steps.size()) != steps.size() ||
      take(&stored, sizeof stored) != sizeof stored)
    throw InputError("cannot be read to its end");
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    throw InputError("holds a number that is not finite");
  Checksum checksum;
  checksum.add(text.data(), header.length);
  checksum.add(values.data(), bytes);
  checksum.add(steps.data(), steps.size());
  if (stored != checksum.value())
    throw InputError("is damaged: its checksum is wrong");
  if (!steps.empty())
    checkpoint.steps = stepsOf(steps);
  return checkpoint;
}

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

} // namespace

std::string checkpointHeader(const Fingerprint& fingerprint, std::size_t length) {
  std::string text(title);
  text.append(version).append("\norder ").append(order).append("\n");
  for (const auto& [name, member] : counts)
    text.append(name).append(" ").append(textOf(fingerprint.*member)).append("\n");
  return text + "rows " + textOf(fingerprint.rows, 16) + "\nstiffness " + textOf(fingerprint.stiffness) +
         "\nsteps " + textOf(length) + "\n\n";
}

void writeCheckpoint(const fs::path& file, const Fingerprint& fingerprint, const Vector& lambda,
                     const simulation::StepsDone* steps) {
  const RCP<const Comm> comm = lambda.getMap()->getComm();
  const RCP<const Map> inOrder = slabMap(fingerprint.numMultipliers(), comm);
  Vector ordered(inOrder);
  ordered.doImport(lambda, Import(lambda.getMap(), inOrder), Tpetra::INSERT);
  const auto mine = ordered.getData();
  const std::vector<double> values =
      gatherOnFirst(*comm, std::span<const double>(mine.getRawPtr(), mine.size()));
  writeTextFile(
      file,
      [&] {
        const std::string done = steps != nullptr ? stepsText(*steps) : std::string();
        std::string text = checkpointHeader(fingerprint, done.size());
        text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
        text.append(done);
        Checksum checksum;
        checksum.add(text.data(), text.size());
        const std::uint64_t seal = checksum.value();
        return text.append(reinterpret_cast<const char*>(&seal), sizeof seal);
      },
      *comm);
}

Checkpoint readCheckpoint(const fs::path& file, const Comm& comm) {
  Checkpoint checkpoint{file, {}, {}, {}};
  collectively(comm, [&] {
    about(file, [&] {
      if (comm.getRank() == 0)
        checkpoint = readOnThisRank(file);
    });
  });
  Teuchos::broadcast(comm, 0, static_cast<int>(sizeof(Fingerprint)),
                     reinterpret_cast<char*>(&checkpoint.fingerprint));
  const std::string steps = agreedText(comm, checkpoint.steps ? stepsText(*checkpoint.steps) : std::string());
  if (!checkpoint.steps && !steps.empty())
    checkpoint.steps = stepsOf(steps);
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
  const RCP<const Map> onFirst =
      rcp(new Map(fingerprint.numMultipliers(), checkpoint.values.size(), 0, problem.comm));
  Vector whole(onFirst);
  std::copy(checkpoint.values.begin(), checkpoint.values.end(), whole.getDataNonConst().begin());
  const RCP<Vector> lambda = rcp(new Vector(problem.multiplierMap));
  lambda->doImport(whole, Import(onFirst, problem.multiplierMap), Tpetra::INSERT);
  return lambda;
}

} // namespace epafi::output
