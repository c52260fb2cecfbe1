#include "DeckFiles.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/output/FileSet.hpp"
#include "epafi/scene/ParameterFile.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace epafi::drivers {
namespace {

namespace fs = std::filesystem;

deck::DeckModel modelIn(const std::string& scene) {
  return modelOf(deck::readDeck(scene), fs::path(scene).filename().string());
}

/// Numbers of each body, none twice: later ones are counted on.
std::vector<std::vector<GlobalOrdinal>> allDifferent(std::vector<std::vector<GlobalOrdinal>> numbers) {
  GlobalOrdinal last = 0;
  for (const std::vector<GlobalOrdinal>& own : numbers)
    last = own.empty() ? last : std::max(last, *std::max_element(own.begin(), own.end()));
  std::set<GlobalOrdinal> known;
  for (std::vector<GlobalOrdinal>& own : numbers)
    for (GlobalOrdinal& number : own)
      if (!known.insert(number).second)
        number = ++last;
  return numbers;
}

} // namespace

std::string notesOf(const std::string& scene) {
  std::string notes;
  if (deck::isDeck(scene))
    for (const std::string& note : modelIn(scene).notes)
      notes += "  deck        " + note + '\n';
  return notes;
}

std::vector<std::vector<GlobalOrdinal>> nodeNumbersOf(const std::string& scene) {
  return deck::isDeck(scene) ? modelIn(scene).nodeNumbers : std::vector<std::vector<GlobalOrdinal>>();
}

output::FrdNumbering numberingOf(const std::string& scene) {
  if (!deck::isDeck(scene))
    return {};
  const deck::DeckModel model = modelIn(scene);
  const auto numbersIn = [](std::vector<std::vector<GlobalOrdinal>> numbers) {
    return [all = std::make_shared<const std::vector<std::vector<GlobalOrdinal>>>(std::move(numbers))](
               int body, GlobalOrdinal index) { return (*all)[body].at(index); };
  };
  return {numbersIn(allDifferent(model.nodeNumbers)), numbersIn(model.elementNumbers)};
}

void exportDeck(const std::string& scene, const std::string& file, const RCP<const Comm>& comm) {
  std::string text, mesh;
  const fs::path meshFile = fs::path(file).replace_extension(".msh");
  collectively(*comm, [&] {
    if (!deck::isDeck(scene))
      throw InputError("option --export is for input decks, but " + inQuotes(scene) + " is none (.inp)");
    if (!file.ends_with(".xml"))
      throw InputError("option --export writes a scene, whose name should end in .xml, not " +
                       inQuotes(file));
    if (comm->getRank() > 0)
      return;
    const deck::Deck deck = deck::readDeck(scene);
    const deck::DeckModel model = modelOf(deck, meshFile.filename().string());
    text = scene::xmlText(model.scene);
    mesh = mshText(deck, model.groups);
  });
  output::FileSet files(comm);
  files.write(meshFile, [&] { return mesh; });
  files.write(file, [&] { return text; });
  files.publish();
}

} // namespace epafi::drivers
