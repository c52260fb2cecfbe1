#include "epafi/deck/DeckReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/deck/ConditionCards.hpp"
#include "epafi/deck/ContactCards.hpp"
#include "epafi/deck/Keywords.hpp"
#include "epafi/deck/MaterialCards.hpp"
#include "epafi/deck/MeshCards.hpp"
#include "epafi/deck/StepCards.hpp"

#include <algorithm>
#include <map>

namespace epafi::deck {
namespace {

/// Where a card may stand.
enum class Where { anywhere, model, step };

/// A keyword that is read, with the parameters that are.
struct Heeded {
  const char* keyword;
  Where where;
  std::vector<std::string> parameters;
  void (*read)(Reading&, const Card&);
};

void readBefore(Reading&, const Card&) {} // before all others

const std::vector<Heeded> heededKeywords{
    {"HEADING", Where::anywhere, {}, readHeading},
    {"NODE", Where::model, {"NSET"}, readBefore},
    {"ELEMENT", Where::model, {"TYPE", "ELSET"}, readBefore},
    {"NSET", Where::anywhere, {"NSET", "GENERATE"}, readBefore},
    {"ELSET", Where::anywhere, {"ELSET", "GENERATE"}, readBefore},
    {"SURFACE", Where::anywhere, {"NAME", "TYPE"}, readSurface},
    {"MATERIAL", Where::model, {"NAME"}, readMaterial},
    {"ELASTIC", Where::model, {"TYPE"}, readElastic},
    {"DENSITY", Where::model, {}, readDensity},
    {"EXPANSION", Where::model, {"TYPE", "ZERO"}, readExpansion},
    {"ORIENTATION", Where::model, {"NAME", "SYSTEM", "DEFINITION"}, readOrientation},
    {"SOLID SECTION", Where::model, {"ELSET", "MATERIAL", "ORIENTATION"}, readSolidSection},
    {"MEMBRANE", Where::model, {"ELSET", "MATERIAL", "ORIENTATION"}, readOtherSection},
    {"MEMBRANE SECTION", Where::model, {"ELSET", "MATERIAL", "ORIENTATION"}, readOtherSection},
    {"SHELL SECTION", Where::model, {"ELSET", "MATERIAL", "ORIENTATION", "COMPOSITE"}, readOtherSection},
    {"BEAM SECTION", Where::model, {"ELSET", "MATERIAL", "ORIENTATION", "SECTION"}, readOtherSection},
    {"TRANSFORM", Where::model, {"NSET", "TYPE"}, readTransform},
    {"EQUATION", Where::model, {}, readEquation},
    {"COUPLING", Where::model, {"CONSTRAINTNAME", "REFNODE", "SURFACE"}, readCoupling},
    {"DISTRIBUTING", Where::model, {}, readDistributing},
    {"DISTRIBUTING COUPLING", Where::model, {"ELSET"}, readDistributingCoupling},
    {"AMPLITUDE", Where::anywhere, {"NAME", "TIME", "DEFINITION", "USER", "SHIFTX", "SHIFTY"}, readAmplitude},
    {"SURFACE INTERACTION", Where::model, {"NAME"}, readInteraction},
    {"SURFACE BEHAVIOR", Where::model, {"PRESSURE-OVERCLOSURE"}, readSurfaceBehavior},
    {"FRICTION", Where::anywhere, {}, readFriction},
    {"CONTACT PAIR", Where::model, {"INTERACTION", "TYPE", "ADJUST", "SMALLSLIDING"}, readContactPair},
    {"TIE", Where::model, {"NAME", "POSITIONTOLERANCE", "ADJUST"}, readTie},
    {"PRE-TENSION SECTION", Where::model, {"SURFACE", "ELEMENT", "NODE"}, readPretension},
    {"INITIAL CONDITIONS", Where::model, {"TYPE"}, readInitialConditions},
    {"BOUNDARY", Where::anywhere, {"OP", "AMPLITUDE", "TIMEDELAY", "FIXED"}, readBoundary},
    {"STEP", Where::anywhere, {"NLGEOM", "PERTURBATION", "AMPLITUDE"}, readStep},
    {"STATIC", Where::step, {"SOLVER"}, readStatic},
    {"END STEP", Where::step, {}, readEndStep},
    {"CLOAD", Where::step, {"OP", "AMPLITUDE", "TIMEDELAY"}, readNodeForce},
    {"DLOAD", Where::step, {"OP", "AMPLITUDE", "TIMEDELAY"}, readElementLoad},
    {"DSLOAD", Where::step, {"OP", "AMPLITUDE", "TIMEDELAY"}, readSurfaceLoad},
    {"TEMPERATURE", Where::step, {"OP", "AMPLITUDE", "TIMEDELAY"}, readTemperature},
    {"NODE PRINT", Where::anywhere, {}, readNodePrint},
    {"EL PRINT", Where::anywhere, {}, readElementPrint},
    {"CONTACT PRINT", Where::anywhere, {}, readContactPrint},
    {"SECTION PRINT", Where::anywhere, {}, readSectionPrint},
    {"CHANGE FRICTION", Where::step, {"INTERACTION"}, readFrictionChange},
    {"MODEL CHANGE", Where::step, {"TYPE", "ADD", "REMOVE"}, readModelChange}};

const Heeded* findHeeded(const std::string& keyword) {
  static const std::map<std::string, const Heeded*> known = [] {
    std::map<std::string, const Heeded*> result;
    for (const Heeded& heeded : heededKeywords)
      result.emplace(squeezed(heeded.keyword), &heeded);
    return result;
  }();
  const auto found = known.find(keyword);
  return found == known.end() ? nullptr : found->second;
}

[[noreturn]] void refuseUnknown(const Card& card) {
  std::vector<std::string> names = otherKeywords();
  for (const Heeded& heeded : heededKeywords)
    names.emplace_back(heeded.keyword);
  const std::string near = nearestName(card.shown.substr(1), names);
  card.refuse("this keyword is not known; " +
              (near.empty() ? "take it out, or write it as CalculiX does" : "did you mean *" + near + '?'));
}

/// Names parameters that make no difference, and refuses those that are not known.
void checkParameters(Reading& reading, const Card& card, const Heeded& heeded) {
  if (card.keyword.ends_with("PRINT")) // whose parameters change nothing but how much is printed
    return;
  for (const Parameter& parameter : card.parameters) {
    if (std::find(heeded.parameters.begin(), heeded.parameters.end(), parameter.name) !=
        heeded.parameters.end())
      continue;
    if (!isIgnoredParameter(parameter.name)) {
      std::vector<std::string> names = ignoredParameters();
      names.insert(names.begin(), heeded.parameters.begin(), heeded.parameters.end());
      const std::string near = nearestName(parameter.name, names);
      card.refuse("the parameter " + shortened(parameter.name) + " is not known; " +
                  (near.empty() ? "take it out" : "did you mean " + near + '?'));
    }
    reading.ignore(card.shown + ", " + parameter.name, card.place);
  }
}

void checkPlace(const Reading& reading, const Card& card, Where where) {
  if (where == Where::step && !reading.isInStep)
    card.refuse("it belongs in a step, between *STEP and *END STEP");
  if (where == Where::model && (reading.isInStep || !reading.deck.steps.empty()))
    card.refuse("it belongs before the first *STEP");
}

void readCard(Reading& reading, const Card& card) {
  if (isIgnoredKeyword(card.keyword)) {
    reading.ignore(card.shown, card.place);
    return;
  }
  const Heeded& heeded = *findHeeded(card.keyword);
  checkPlace(reading, card, heeded.where);
  checkParameters(reading, card, heeded);
  if (reading.awaitsDistributing && card.keyword != "DISTRIBUTING")
    throw InputError(text(reading.deck.couplings.back().place) +
                     ": *COUPLING: behind it belongs *DISTRIBUTING, by which the node passes forces on");
  heeded.read(reading, card);
}

/// What is of faces must not be of nodes.
void checkSurfaces(const Reading& reading) {
  const auto requireFaces = [&](const Place& place, const std::string& name, const char* what) {
    if (reading.deck.surfaces.at(name).ofNodes)
      throw InputError(text(place) + ": " + what + " is the surface \"" + shortened(name) +
                       "\", which is one of nodes; give one of elements' faces.");
  };
  for (const ContactPair& pair : reading.deck.contacts)
    requireFaces(pair.place, pair.independent, "the independent (master) side");
  for (const Tie& tie : reading.deck.ties)
    requireFaces(tie.place, tie.independent, "the independent (master) side");
  for (const Coupling& coupling : reading.deck.couplings)
    if (!coupling.surface.empty())
      requireFaces(coupling.place, coupling.surface, "what forces are spread over");
  for (const Pretension& pretension : reading.deck.pretensions)
    if (!pretension.surface.empty())
      requireFaces(pretension.place, pretension.surface, "the section of the bolt");
  for (const Step& step : reading.deck.steps)
    for (const DistributedLoad& load : step.loads)
      if (!load.surface.empty())
        requireFaces(load.place, load.surface, "what the pressure is on");
}

} // namespace

Deck deckOf(const Cards& cards, const std::string& name) {
  refuseBeyond(cards.list());
  for (const Card& card : cards.list())
    if (findHeeded(card.keyword) == nullptr && !isIgnoredKeyword(card.keyword))
      refuseUnknown(card);
  Reading reading;
  reading.deck.file = name;
  if (cards.textInFront())
    reading.ignore("text before the first keyword", *cards.textInFront());
  readNodes(reading, cards.list());
  readElements(reading, cards.list());
  readSets(reading, cards.list());
  for (const Card& card : cards.list())
    readCard(reading, card);
  if (reading.isInStep)
    throw InputError(text(reading.step().place) +
                     ": *STEP: the deck ends before the step does; put *END STEP "
                     "behind it, or look whether the file is cut off.");
  reading.checkReferences();
  checkSurfaces(reading);
  return std::move(reading.deck);
}

Deck parseDeck(const std::string& text, const std::string& name) {
  return deckOf(Cards(name, text,
                      [](const std::string&, const Card& card) -> std::string {
                        card.refuse("a text includes no files; read the deck from its file");
                      }),
                name);
}

} // namespace epafi::deck
