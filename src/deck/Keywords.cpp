#include "epafi/deck/Keywords.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/deck/ConditionCards.hpp"
#include "epafi/deck/Reading.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace epafi::deck {
namespace {

using Names = std::vector<std::string>;

const Names ignoredKeywords{"NODE FILE",          "EL FILE",      "ELEMENT FILE",   "CONTACT FILE",
                            "SECTION FILE",       "NODE OUTPUT",  "ELEMENT OUTPUT", "CONTACT OUTPUT",
                            "ENERGY OUTPUT",      "ENERGY PRINT", "OUTPUT",         "FILE FORMAT",
                            "FILE OUTPUT",        "PREPRINT",     "MONITOR",        "PRINT",
                            "CONTROLS",           "TIME POINTS",  "CONDUCTIVITY",   "SPECIFIC HEAT",
                            "PHYSICAL CONSTANTS", "DAMPING",      "DIAGNOSTICS",    "RESTART"};

const Names ignoredNames{"FREQUENCY", "TIMEPOINTS",    "OUTPUT",      "LASTITERATIONS", "CONTACTELEMENTS",
                         "FORCED",    "INC",           "INCF",        "SOLVER",         "DIRECT",
                         "EXPLICIT",  "UNSYMM",        "EXTRAPOLATE", "CONVERTSDI",     "OFFSET",
                         "CONTROLS",  "REFNODE",       "POSITION",    "INTERNAL",       "UNSORTED",
                         "ALLSDTOL",  "CONTINUE",      "MODULI",      "NUMBERINTERVAL", "SUMMARY",
                         "NODAL",     "SLIPTOLERANCE", "REGION",      "VARIABLE",       "FIELD",
                         "HISTORY",   "WRITE",         "NAME"};

/// Keywords of one kind, why they are refused, and what to do.
struct RefusedKeywords {
  Names keywords;
  const char* reason;
};

const std::array refusedKeywords{
    RefusedKeywords{{"FREQUENCY",
                     "BUCKLE",
                     "DYNAMIC",
                     "MODAL DYNAMIC",
                     "STEADY STATE DYNAMICS",
                     "COMPLEX FREQUENCY",
                     "VISCO",
                     "SENSITIVITY",
                     "GREEN",
                     "NO ANALYSIS",
                     "SUBSTRUCTURE GENERATE",
                     "CRACK PROPAGATION",
                     "CFD",
                     "ELECTROMAGNETICS",
                     "ROBUST DESIGN",
                     "FEASIBLE DIRECTION",
                     "SELECT CYCLIC SYMMETRY MODES",
                     "RETAINED NODAL DOFS",
                     "SUBSTRUCTURE MATRIX OUTPUT",
                     "MODAL DAMPING",
                     "DESIGN VARIABLES",
                     "OBJECTIVE",
                     "DESIGN RESPONSE",
                     "CONSTRAINT",
                     "FILTER",
                     "CORRELATION LENGTH",
                     "MATRIX ASSEMBLE",
                     "GEOSTATIC",
                     "SOILS",
                     "BASE MOTION",
                     "REFINE MESH",
                     "GEOMETRIC TOLERANCES",
                     "RANDOM FIELD"},
                    "Epafi solves *STATIC steps alone; leave the step out, or make it one"},
    RefusedKeywords{{"HEAT TRANSFER", "COUPLED TEMPERATURE-DISPLACEMENT",
                     "UNCOUPLED TEMPERATURE-DISPLACEMENT", "CFLUX", "DFLUX", "FILM", "RADIATE", "VIEWFACTOR",
                     "GAP CONDUCTANCE", "GAP HEAT GENERATION", "MASS FLOW", "BOUNDARYF", "EQUATIONF",
                     "TRANSFORMF", "MAGNETIC PERMEABILITY", "ELECTRICAL CONDUCTIVITY"},
                    "temperatures are not computed here; prescribe them by *TEMPERATURE in a *STATIC step"},
    RefusedKeywords{{"FLUID CONSTANTS", "FLUID SECTION", "FLUID SECTIONS", "SPECIFIC GAS CONSTANT",
                     "VALUES AT INFINITY", "TURBULENCE MODEL", "POROUS"},
                    "fluids are not computed here; take them out"},
    RefusedKeywords{{"PLASTIC", "CYCLIC HARDENING", "CREEP", "HYPERELASTIC", "HYPERFOAM", "USER MATERIAL",
                     "DEFORMATION PLASTICITY", "MOHR COULOMB", "MOHR COULOMB HARDENING", "RATE DEPENDENT",
                     "DEPVAR", "VISCOELASTIC", "DRUCKER PRAGER", "CONCRETE", "NO COMPRESSION", "FAIL STRESS"},
                    "bodies are linearly elastic here; take it out, and leave the material its *ELASTIC"},
    RefusedKeywords{{"MPC", "RIGID BODY", "KINEMATIC", "KINEMATIC COUPLING", "NETWORK MPC",
                     "EMBEDDED ELEMENT", "RELEASE"},
                    "such joints of nodes are not read; write *EQUATION, *TIE or *BOUNDARY"},
    RefusedKeywords{
        {"CYCLIC SYMMETRY MODEL"},
        "cyclic symmetry is not read; hold the planes of the sector by *TRANSFORM and *BOUNDARY, or "
        "give the whole ring"},
    RefusedKeywords{{"BEAM GENERAL SECTION", "NODAL THICKNESS", "NORMAL", "SPRING", "DASHPOT", "GAP", "MASS",
                     "ROTARY INERTIA", "USER ELEMENT", "USER SECTION", "MATRIX INPUT", "SUPER ELEMENT"},
                    "bodies are solids here; model the part by solid elements, or leave it out"},
    RefusedKeywords{
        {"CHANGE SOLID SECTION", "CHANGE SURFACE BEHAVIOR", "CHANGE CONTACT TYPE", "CHANGE MATERIAL",
         "CHANGE PLASTIC", "CHANGE MPC"},
        "what stays the same from step to step here it changes; make decks of their own of the steps"},
    RefusedKeywords{{"SUBMODEL"},
                    "results of another model are not read; give their displacements by *BOUNDARY"},
    RefusedKeywords{{"CLEARANCE"},
                    "the gap is that of the nodes' places; move them, or write ADJUST= in *CONTACT PAIR"},
    RefusedKeywords{{"CONTACT", "CONTACT INCLUSIONS", "CONTACT PROPERTY ASSIGNMENT", "CONTACT DAMPING",
                     "CONTACT EXCLUSIONS"},
                    "general contact is not read; name the surfaces by *CONTACT PAIR"},
    RefusedKeywords{
        {"PART", "END PART", "ASSEMBLY", "END ASSEMBLY", "INSTANCE", "END INSTANCE"},
        "parts and instances are not read; write the deck without them (Abaqus/CAE: Do not use parts and "
        "assemblies in input files)"},
    RefusedKeywords{{"SYSTEM", "PARAMETER", "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY",
                     "NODE RESPONSE", "IMPORT", "INITIAL STRAIN INCREASE"},
                    "it is not read; write out the numbers that it makes, or take it out"}};

/// A parameter that is refused in a card, with any value or with one.
struct RefusedParameter {
  const char *keyword, *parameter, *value;
  const char* reason;
};

constexpr const char* prescribedOnly =
    "values of a subroutine or of another model are not read; write them out";
constexpr const char* notHarmonic = "loads are static here; leave it out";

const std::array refusedParameters{
    RefusedParameter{
        "INITIALCONDITIONS", "TYPE", "!TEMPERATURE",
        "bodies have no stresses, strains or velocities at first; TYPE=TEMPERATURE is read alone"},
    RefusedParameter{"INITIALCONDITIONS", "USER", "", prescribedOnly},
    RefusedParameter{"INITIALCONDITIONS", "FILE", "", prescribedOnly},
    RefusedParameter{"RESTART", "READ", "",
                     "a deck begins with its own model; give that and all steps in one"},
    RefusedParameter{"SURFACEBEHAVIOR", "PRESSURE-OVERCLOSURE", "EXPONENTIAL",
                     "its stiffness depends on the gap; write HARD, or LINEAR with a stiffness"},
    RefusedParameter{"SURFACEBEHAVIOR", "PRESSURE-OVERCLOSURE", "TABULAR",
                     "its stiffness depends on the gap; write HARD, or LINEAR with a stiffness"},
    RefusedParameter{"SURFACEBEHAVIOR", "NO SEPARATION", "",
                     "surfaces may part here; write *TIE where they may not"},
    RefusedParameter{"FRICTION", "ROUGH", "", "give a coefficient of friction"},
    RefusedParameter{"FRICTION", "TAUMAX", "", "friction is Coulomb's without a limit; leave it out"},
    RefusedParameter{"FRICTION", "USER", "", prescribedOnly},
    RefusedParameter{"CONTACTPAIR", "TYPE", "MASSLESS", "that is for *DYNAMIC; write SURFACE TO SURFACE"},
    RefusedParameter{"CONTACTPAIR", "TIED", "", "write *TIE"},
    RefusedParameter{"MODELCHANGE", "TYPE", "ELEMENT",
                     "bodies stay the same; TYPE=CONTACT PAIR is read alone"},
    RefusedParameter{"TIE", "CYCLIC SYMMETRY", "", "cyclic symmetry is not read; give the whole ring"},
    RefusedParameter{"TIE", "MULTISTAGE", "", "cyclic symmetry is not read; give the whole ring"},
    RefusedParameter{"TIE", "FLUID PERIODIC", "", "fluids are not computed here"},
    RefusedParameter{"TIE", "FLUID CYCLIC", "", "fluids are not computed here"},
    RefusedParameter{"EQUATION", "REMOVE", "",
                     "equations hold in all steps; make decks of their own of the steps"},
    RefusedParameter{"EQUATION", "REMOVE ALL", "",
                     "equations hold in all steps; make decks of their own of the steps"},
    RefusedParameter{"BOUNDARY", "MASS FLOW", "", "fluids are not computed here"},
    RefusedParameter{"BOUNDARY", "USER", "", prescribedOnly},
    RefusedParameter{"BOUNDARY", "SUBMODEL", "", prescribedOnly},
    RefusedParameter{"BOUNDARY", "LOAD CASE", "", notHarmonic},
    RefusedParameter{"CLOAD", "USER", "", prescribedOnly},
    RefusedParameter{"CLOAD", "SUBMODEL", "", prescribedOnly},
    RefusedParameter{"CLOAD", "LOAD CASE", "", notHarmonic},
    RefusedParameter{"CLOAD", "SECTOR", "", notHarmonic},
    RefusedParameter{"CLOAD", "OMEGA0", "", notHarmonic},
    RefusedParameter{"CLOAD", "FOLLOWER", "", "forces keep their direction here; leave it out"},
    RefusedParameter{"DLOAD", "USER", "", prescribedOnly},
    RefusedParameter{"DLOAD", "LOAD CASE", "", notHarmonic},
    RefusedParameter{"DLOAD", "SECTOR", "", notHarmonic},
    RefusedParameter{"DSLOAD", "SUBMODEL", "", prescribedOnly},
    RefusedParameter{"DSLOAD", "USER", "", prescribedOnly},
    RefusedParameter{"TEMPERATURE", "FILE", "", prescribedOnly},
    RefusedParameter{"TEMPERATURE", "SUBMODEL", "", prescribedOnly},
    RefusedParameter{"TEMPERATURE", "USER", "", prescribedOnly},
    RefusedParameter{"EXPANSION", "USER", "", prescribedOnly},
    RefusedParameter{"NODE", "SYSTEM", "", "nodes are read as x, y, z; write them so"},
    RefusedParameter{"STATIC", "RIKS", "", "loads follow time here; leave it out"},
    RefusedParameter{"STATIC", "TIME RESET", "", "time goes on from step to step; leave it out"},
    RefusedParameter{"STATIC", "TOTAL TIME AT START", "", "time goes on from step to step; leave it out"},
    RefusedParameter{"NSET", "ELSET", "", "nodes of elements are not looked for; write their numbers"},
    RefusedParameter{"NSET", "INSTANCE", "", "instances are not read; write the deck without them"},
    RefusedParameter{"ELSET", "INSTANCE", "", "instances are not read; write the deck without them"},
    RefusedParameter{"SOLIDSECTION", "COMPOSITE", "", "a section is of one material; name it by MATERIAL="},
    RefusedParameter{"ELASTIC", "DEPENDENCIES", "", "constants depend on temperature alone"}};

/// What elements are whose types begin so, in the order in which they are tried.
struct OtherElements {
  const char *begin, *are;
};

constexpr std::array otherElements{
    OtherElements{"SPRING", "springs"},  OtherElements{"DASHPOT", "dashpots"},
    OtherElements{"DCOUP", "couplings"}, OtherElements{"GAP", "gaps"},
    OtherElements{"MASS", "masses"},     OtherElements{"B", "beams"},
    OtherElements{"S", "shells"},        OtherElements{"M3D", "membranes"},
    OtherElements{"T", "trusses"},       OtherElements{"D", "networks of fluids"},
    OtherElements{"F", "fluids"},        OtherElements{"", "elements of this type"}};

std::string reasonOfElement(const std::string& type) {
  const auto* const other =
      std::find_if(otherElements.begin(), otherElements.end(),
                   [&](const OtherElements& elements) { return type.starts_with(elements.begin); });
  return std::string(other->are) + " are not read; model the part by one of " + listed(elementTypeNames());
}

const std::set<std::string>& squeezedNames(const Names& names) {
  static std::map<const Names*, std::set<std::string>> known;
  std::set<std::string>& result = known[&names];
  if (result.empty())
    for (const std::string& name : names)
      result.insert(squeezed(name));
  return result;
}

/// What of the card's parameters stands in its name: the one by which it is refused, and USER.
std::string nameWith(const Card& card, const RefusedParameter& refused) {
  std::string name = card.shown + ", " + refused.parameter;
  const std::string value = card.value(squeezed(refused.parameter));
  if (!value.empty())
    name += '=' + shortened(value);
  if (card.has("USER") && std::string_view(refused.parameter) != "USER")
    name += ", USER";
  return name;
}

bool isRefused(const Card& card, const RefusedParameter& refused) {
  if (card.keyword != refused.keyword)
    return false;
  const std::string parameter = squeezed(refused.parameter), value = card.value(parameter);
  const std::string_view wrong = refused.value;
  if (!card.has(parameter))
    return false;
  return wrong.empty() || (wrong[0] == '!' ? value != wrong.substr(1) : value == wrong);
}

} // namespace

bool isIgnoredKeyword(const std::string& keyword) {
  return squeezedNames(ignoredKeywords).contains(keyword);
}

bool isIgnoredParameter(const std::string& parameter) {
  return squeezedNames(ignoredNames).contains(parameter);
}

std::optional<Refusal> refusalOf(const Card& card) {
  for (const RefusedKeywords& refused : refusedKeywords)
    if (squeezedNames(refused.keywords).contains(card.keyword)) {
      std::string name = card.shown;
      if (card.keyword == "MPC" && !card.data.empty())
        name += ' ' + shortened(squeezed(Fields(card, card.data[0])[0]));
      return Refusal{name, card.place, refused.reason};
    }
  for (const RefusedParameter& refused : refusedParameters)
    if (isRefused(card, refused))
      return Refusal{nameWith(card, refused), card.place, refused.reason};
  if (card.keyword == "ELEMENT" && findElementType(card.required("TYPE")) == nullptr &&
      !isCoupling(card.required("TYPE")))
    return Refusal{card.shown + ", TYPE=" + shortened(card.value("TYPE")), card.place,
                   reasonOfElement(card.value("TYPE"))};
  return std::nullopt;
}

void refuseBeyond(const std::vector<Card>& cards) {
  constexpr std::size_t most = 8;
  std::optional<Refusal> first;
  std::vector<std::string> names, others;
  for (const Card& card : cards)
    if (const std::optional<Refusal> refusal = refusalOf(card)) {
      if (names.size() > most)
        break;
      if (std::find(names.begin(), names.end(), refusal->name) != names.end())
        continue;
      names.push_back(refusal->name);
      if (first)
        others.push_back(refusal->name + " (" + text(refusal->place) + ')');
      else
        first = refusal;
    }
  if (!first)
    return;
  throw InputError(asSentence(text(first->place) + ": " + first->name + ": " + first->reason) +
                   (others.empty() ? "" : " Beyond Epafi as well: " + listed(others) + '.'));
}

std::vector<std::string> otherKeywords() {
  Names names = ignoredKeywords;
  for (const RefusedKeywords& refused : refusedKeywords)
    names.insert(names.end(), refused.keywords.begin(), refused.keywords.end());
  return names;
}

std::vector<std::string> ignoredParameters() {
  return ignoredNames;
}

} // namespace epafi::deck
