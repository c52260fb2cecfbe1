#include "epafi/base/Errors.hpp"
#include "epafi/deck/DeckReader.hpp"

#include <zlib.h>

#include <array>
#include <filesystem>
#include <memory>

namespace epafi::deck {
namespace {

namespace fs = std::filesystem;

/// The file's text, unpacked if it is gzip'ed.
/// \param sentence  where the file is named, in front of what is wrong
std::string unpackedText(const fs::path& file, const std::string& sentence) {
  constexpr std::size_t chunk = 1u << 16;
  std::error_code error;
  if (!fs::exists(file, error))
    throw InputError(sentence + " does not exist.");
  const std::unique_ptr<gzFile_s, decltype(&gzclose)> stream(gzopen(file.c_str(), "rb"), &gzclose);
  std::string text;
  std::array<char, chunk> bytes;
  int numBytes = -1;
  while (stream && (numBytes = gzread(stream.get(), bytes.data(), bytes.size())) > 0)
    text.append(bytes.data(), static_cast<std::size_t>(numBytes));
  int state = Z_OK;
  if (stream)
    gzerror(stream.get(), &state); // of a file that is cut off there is no other sign
  if (numBytes < 0 || state != Z_OK)
    throw InputError(sentence + " cannot be read to its end; it is damaged, cut off, or no file.");
  return text;
}

} // namespace

Deck readDeck(const std::string& file) {
  const fs::path path(file);
  const std::string name = path.filename().string();
  const auto include = [&](const std::string& included, const Card& card) {
    return unpackedText(path.parent_path() / included,
                        text(card.place) + ": *INCLUDE: the file \"" + shortened(included) + '"');
  };
  return deckOf(Cards(name, unpackedText(path, "The deck \"" + shortened(file) + '"'), include), name);
}

} // namespace epafi::deck
