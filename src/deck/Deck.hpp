#pragma once

/// What an input deck of Abaqus or CalculiX says, as plain values in the deck's own numbers and units. Every
/// reference in it holds: nodes, elements, sets, materials, surfaces and amplitudes that are named are there.

#include "epafi/base/Types.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace epafi::deck {

/// Where something stands.
struct Place {
  std::string file; ///< as the deck names it, without its folder
  int line = 0;     ///< from 1 on
};

/// "beam.inp, line 12".
std::string text(const Place& place);

struct Nodes {
  std::vector<GlobalOrdinal> numbers; ///< ascending
  std::vector<Point> points;          ///< one a number
};

/// The elements of one type.
struct Elements {
  std::string type; ///< as written, upper case: C3D20R
  int nodesPerElement = 0;
  std::vector<GlobalOrdinal> numbers; ///< ascending
  std::vector<GlobalOrdinal> nodes;   ///< nodesPerElement a number, in the deck's order
  Place place;                        ///< of the first card of this type
};

/// Names in upper case; numbers ascending, none twice.
using Sets = std::map<std::string, std::vector<GlobalOrdinal>>;

struct Surface {
  Place place;
  bool ofNodes = false;                             ///< TYPE=NODE
  std::vector<std::pair<GlobalOrdinal, int>> faces; ///< element and face, S1 ... S6 as 1 ... 6
  std::vector<GlobalOrdinal> nodes;                 ///< ascending, if it is one of nodes
};

struct ElasticConstants {
  /// How many constants: E, ν; D1111 D1122 D2222 D1133 D2233 D3333 D1212 D1313 D2323; 21 in the order of the
  /// upper triangle's columns (11 22 33 12 13 23).
  enum class Kind { isotropic, orthotropic, anisotropic };
  struct Row {
    double temperature = 0;
    std::vector<double> constants;
  };
  Kind kind = Kind::isotropic;
  std::vector<Row> rows; ///< temperatures ascending
};

struct Expansion {
  struct Row {
    double temperature = 0;
    std::vector<double> coefficients; ///< one, or three along the axes
  };
  double zero = 0; ///< the temperature without strain
  std::vector<Row> rows;
};

struct Material {
  Place place;
  std::optional<ElasticConstants> elastic;
  std::optional<double> density;
  std::optional<Expansion> expansion;
};

/// A local system: rectangular (a on the x-axis, b in the x-y-plane) or cylindrical (a and b on the axis).
struct Orientation {
  Place place;
  bool isCylindrical = false;
  Point a{}, b{};
  int rotationAxis = 0;     ///< 1 ... 3: turned about this local axis, by rotationAngle; 0: not turned
  double rotationAngle = 0; ///< degrees
};

/// *SOLID SECTION.
struct Section {
  Place place;
  std::string elementSet, material;
  std::string orientation; ///< may be empty
  std::optional<double> thickness;
};

/// The local axes of nodes, as those of an Orientation, in which their supports, forces and equations are.
struct Transform {
  Place place;
  std::vector<GlobalOrdinal> nodes;
  bool isCylindrical = false;
  Point a{}, b{};
};

/// Σ factor u_component(node) = 0.
struct Equation {
  struct Term {
    GlobalOrdinal node = 0;
    int component = 1; ///< 1 ... 3
    double factor = 0;
  };
  Place place;
  std::vector<Term> terms;
};

/// A node that stands for others: forces on it are theirs.
struct Coupling {
  Place place;
  GlobalOrdinal node = 0; ///< the reference node
  /// *COUPLING with *DISTRIBUTING: what takes force and moment, linearly in place; else empty.
  std::string surface;
  std::map<GlobalOrdinal, double> weights; ///< *DISTRIBUTING COUPLING: shares of the force; their sum is 1
};

/// A factor over time, linear between the points.
struct Amplitude {
  Place place;
  std::vector<std::pair<double, double>> points; ///< time and factor; times ascending
  bool isOfTotalTime = false;                    ///< otherwise time begins with the step
  /// USER, as CalculiX is delivered: t², whatever the points.
  bool isSquareOfTime = false;
};

/// *SURFACE INTERACTION with its *SURFACE BEHAVIOR and *FRICTION.
struct Interaction {
  /// Pressure over closure; tied: bonded with the stiffness, if it is not 0.
  enum class Law { hard, linear, tied };
  Place place;
  Law law = Law::hard;
  double stiffness = 0;          ///< pressure per closure; of law hard 0: rigid
  std::optional<double> tension; ///< σ∞: the tension at a large gap
  double friction = 0;           ///< μ
  std::optional<double> stickSlope;
};

struct ContactPair {
  Place place;
  std::string interaction;
  std::string dependent;   ///< the slave surface
  std::string independent; ///< the master surface
  bool isSurfaceToSurface = false;
  std::optional<double> adjust; ///< nodes of the dependent surface up to this far are moved onto the other
  std::string adjustSet;        ///< or those of this set of nodes
};

struct Tie {
  Place place;
  std::string name, dependent, independent;
  std::optional<double> tolerance;
};

/// *PRE-TENSION SECTION, of a surface through a solid or of a beam element.
struct Pretension {
  Place place;
  std::string surface;
  std::optional<GlobalOrdinal> element;
  GlobalOrdinal node = 0;         ///< whose component 1 is the force or the shortening
  std::optional<Point> direction; ///< otherwise the surface's own normal
};

/// Prescribed components first ... last, which are of 1 ... 3.
struct Boundary {
  Place place;
  std::vector<GlobalOrdinal> nodes;
  int first = 1, last = 1;
  double value = 0;
  std::string amplitude; ///< may be empty
  bool isFixed = false;  ///< what the last step has come to is held, whatever the value
  double delay = 0;      ///< TIME DELAY: the amplitude's time less this
};

/// *CLOAD.
struct NodeForce {
  Place place;
  std::vector<GlobalOrdinal> nodes;
  int component = 1; ///< 1 ... 3; of nodes that stand for a surface also 4 ... 6, moments
  double value = 0;
  std::string amplitude;
  double delay = 0;
};

/// *DLOAD or *DSLOAD.
struct DistributedLoad {
  Place place;
  std::vector<GlobalOrdinal> elements; ///< none of *DSLOAD
  std::string label;                   ///< P1 ... P6, P, GRAV, CENTRIF
  std::vector<double> values;
  std::string amplitude;
  std::string surface; ///< of *DSLOAD
  double delay = 0;
};

struct Temperature {
  Place place;
  std::vector<GlobalOrdinal> nodes;
  double value = 0;
  std::string amplitude;
  double delay = 0;
};

struct FrictionChange {
  Place place;
  std::string interaction;
  double friction = 0;
  std::optional<double> stickSlope;
};

struct PairChange {
  Place place;
  std::string dependent, independent;
  bool isAdded = false;
};

/// *NODE PRINT, *EL PRINT, *CONTACT PRINT or *SECTION PRINT: what is to be printed at the end of a step.
struct Print {
  enum class Of { nodes, elements, contact, section };
  enum class Totals { none, beside, alone };
  Of of = Of::nodes;
  std::string set{};                      ///< of nodes or elements; the surface of a section
  std::string dependent{}, independent{}; ///< surfaces of the contact; empty: of all contacts
  std::vector<std::string> fields{};      ///< U, RF; S, E, ME, ENER; CDIS, CSTR, CF; SOF, SOM, SOAREA
  Totals totals = Totals::none;
  Place place{};
};

struct Step {
  Place place;
  bool isNonlinear = false; ///< NLGEOM
  bool isPerturbation = false;
  double period = 1;
  /// OP=NEW: what earlier steps prescribed of this kind is gone.
  bool newBoundaries = false, newForces = false, newDistributedLoads = false, newTemperatures = false;
  std::vector<Boundary> boundaries;
  std::vector<NodeForce> forces;
  std::vector<DistributedLoad> loads;
  std::vector<Temperature> temperatures;
  std::vector<FrictionChange> frictions;
  std::vector<PairChange> pairs;
  std::vector<Print> prints; ///< without one of its kind, those of the step before
};

/// What makes no difference here and is passed over; named once.
struct Ignored {
  std::string keyword;
  Place place;
};

struct Deck {
  std::string file, title;
  Nodes nodes;
  std::vector<Elements> elements;
  Sets nodeSets, elementSets;
  std::map<std::string, Surface> surfaces;
  std::map<std::string, Material> materials;
  std::map<std::string, Orientation> orientations;
  std::vector<Section> sections;
  std::vector<Transform> transforms;
  std::vector<Equation> equations;
  std::vector<Coupling> couplings;
  std::map<std::string, Amplitude> amplitudes;
  std::map<std::string, Interaction> interactions;
  std::vector<ContactPair> contacts;
  std::vector<Tie> ties;
  std::vector<Pretension> pretensions;
  std::vector<Temperature> initialTemperatures;
  std::vector<Boundary> boundaries; ///< before the first step
  std::vector<Step> steps;
  std::vector<Ignored> ignored;
};

/// The deck in the file, `.inp` or gzip'ed `.inp.gz`, with the files that it includes, whose names are
/// relative to its folder. Not collective: the rank that calls it reads.
/// \throws InputError  "beam.inp, line 12: *PLASTIC: ..." for what is wrong or beyond what Epafi solves
Deck readDeck(const std::string& file);

/// The same of a text; an *INCLUDE in it is refused.
/// \param name  the file's, for errors
Deck parseDeck(const std::string& text, const std::string& name);

} // namespace epafi::deck
