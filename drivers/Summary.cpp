#include "Summary.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace epafi::drivers {
namespace {

using Teuchos::ParameterList;

/// "1.2 GB", "3.4 MB".
std::string bytes(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  if (value >= 1e9)
    text << value / 1e9 << " GB";
  else
    text << value / 1e6 << " MB";
  return text.str();
}

std::string seconds(const ParameterList& list, const char* name) {
  const double value = list.get<double>(name);
  std::ostringstream text;
  text << std::fixed << std::setprecision(value < 1 ? 3 : 2) << value << " s";
  return text.str();
}

std::string scientific(const ParameterList& list, const char* name, int digits) {
  std::ostringstream text;
  text << std::scientific << std::setprecision(digits) << list.get<double>(name);
  return text.str();
}

GlobalOrdinal count(const ParameterList& list, const char* name) {
  return list.isType<int>(name) ? list.get<int>(name) : list.get<GlobalOrdinal>(name);
}

/// "1 rank", "2 ranks".
std::string counted(GlobalOrdinal number, const std::string& noun) {
  return std::to_string(number) + ' ' + noun + (number == 1 ? "" : "s");
}

std::string counted(const ParameterList& list, const char* name, const std::string& noun) {
  return counted(count(list, name), noun);
}

/// Names of the floating bodies; empty if there are none.
std::string floatingBodies(const SceneRun& run) {
  std::string names;
  for (const auto& body : run.decomposition->problem.bodies)
    if (body.kernelDimension > 0)
      names += (names.empty() ? "" : ", ") + body.name;
  return names;
}

void describeProblem(std::ostream& text, const SceneRun& run) {
  const ParameterList& problem = run.report.sublist("Problem");
  text << "  problem     " << counted(problem, "Primal Dimension", "primal unknown") << " in "
       << counted(problem, "Subdomains", "subdomain") << " on " << counted(problem, "Ranks", "rank") << ", "
       << counted(problem, "Crosspoints", "crosspoint") << "\n              "
       << counted(problem, "Dual Dimension", "multiplier") << ": " << count(problem, "Inequality Multipliers")
       << " of contact, ";
  const GlobalOrdinal ties = run.decomposition->problem.numTies;
  if (ties > 0)
    text << ties << " of tied joints, ";
  text << count(problem, "Equality Multipliers") - ties << " of gluing\n";
  for (std::size_t b = 0; b < run.scene.bodies.size(); ++b) {
    const scene::Decomposition& asked = run.scene.bodies[b].decomposition;
    const int parts = run.decomposition->bodies[b].partition->numParts();
    if (asked.method == scene::Decomposition::Method::metis && asked.parts > 0 && asked.parts != parts)
      text << "              METIS cut body '" << run.scene.bodies[b].name << "' into "
           << counted(parts, "connected part") << ", not the " << asked.parts << " asked for\n";
  }
  const bool isChosen = std::any_of(run.scene.bodies.begin(), run.scene.bodies.end(),
                                    [](const scene::Body& body) { return body.decomposition.cluster < 0; });
  if (const auto clusters = run.decomposition->problem.clusters.size(); clusters > run.scene.bodies.size())
    text << "  clusters    " << clusters << " of subdomains that share crosspoints, "
         << counted(problem, "Kernel Dimension", "rigid motion") << " of them"
         << (isChosen ? ": with so many subdomains and ranks faster than crosspoints of whole bodies\n"
                      : "\n");
  const std::string floating = floatingBodies(run);
  text << "  floating    " << (floating.empty() ? "no body" : floating) << '\n';
}

void describeSolution(std::ostream& text, const SceneRun& run) {
  const ParameterList& algorithm = run.report.sublist("Algorithm");
  const ParameterList& iterations = run.report.sublist("Iterations");
  text << "  algorithm   " << algorithm.get<std::string>("Name") << ": "
       << algorithm.get<std::string>("Reason") << "\n              preconditioner "
       << algorithm.get<std::string>("Preconditioner") << ", subdomains by "
       << algorithm.get<std::string>("Subdomain Solver") << ", coarse problem by "
       << algorithm.get<std::string>("Coarse Solver") << "\n              F "
       << algorithm.get<std::string>("Dual Operator") << '\n';
  if (run.start)
    text << "  start       contact zone of " << run.start->means << ": "
         << counted(run.start->unknowns, "primal unknown") << ", "
         << counted(run.start->multiplications, "product") << " with F\n";
  text << "  iterations  " << counted(iterations, "Hessian Multiplications", "product") << " with F (and "
       << count(iterations, "Norm Estimate Multiplications")
       << " to estimate its norm): " << count(iterations, "CG Steps") << " CG + "
       << count(iterations, "Expansion Steps") << " expansion + " << count(iterations, "Proportioning Steps")
       << " proportioning steps, " << count(iterations, "Outer") << " outer\n";
}

/// "1.2 %", "0.00034 %".
std::string percent(double share) {
  std::ostringstream text;
  text << std::setprecision(2) << 100 * share << " %";
  return text.str();
}

/// "1.2345 ± 0.0012 (0.1 %)".
std::string valueWithBar(double value, double bar) {
  std::ostringstream text;
  text << std::setprecision(8) << value << " ± " << std::setprecision(2) << bar;
  if (value != 0)
    text << " (" << percent(bar / std::abs(value)) << ')';
  return text.str();
}

void describeQuantity(std::ostream& text, const Quantity& quantity) {
  text << "\n  quantity    " << quantity.name << ": ";
  if (quantity.failure.empty())
    text << valueWithBar(quantity.value, quantity.bar + quantity.algebraic)
         << "; its error is estimated to be " << std::setprecision(2) << quantity.error;
  else
    text << std::setprecision(8) << quantity.value << ", without an error bar: " << quantity.failure;
}

/// What of the error the mesh and what the iteration is to blame for.
void describeError(std::ostream& text, const SceneRun& run) {
  const accuracy::ErrorEstimate& error = *run.error;
  const double whole = std::hypot(error.energyNorm, error.discretisation);
  text << "\n              estimated error " << percent(run.relativeError())
       << " of the energy norm: " << percent(error.relative()) << " of the mesh, ";
  if (std::isfinite(run.solution.algebraicError))
    text << percent(whole > 0 ? run.solution.algebraicError / whole : 0) << " of the iteration";
  else
    text << "that of the iteration not measured without preconditioner";
}

void describeAccuracy(std::ostream& text, const SceneRun& run) {
  const ParameterList& accuracy = run.report.sublist("Accuracy");
  std::ostringstream asked;
  if (run.solver->isBalanced())
    asked << "balanced";
  else
    asked << run.solver->tolerance();
  text << "  accuracy    projected gradient " << scientific(accuracy, "Relative Projected Gradient", 2)
       << " (asked " << asked.str() << "), feasibility " << scientific(accuracy, "Feasibility", 2)
       << ", complementarity " << scientific(accuracy, "Complementarity", 2);
  if (!floatingBodies(run).empty())
    text << ", equilibrium " << scientific(accuracy, "Equilibrium", 2);
  if (run.error)
    describeError(text, run);
  if (accuracy.isParameter("Doubts"))
    text << "\n  doubts      " << accuracy.get<std::string>("Doubts");
  if (run.quantity)
    describeQuantity(text, *run.quantity);
  if (accuracy.isParameter("Choice of Order"))
    text << "\n  order       " << accuracy.get<std::string>("Choice of Order");
  text << "\n  solution    energy " << scientific(accuracy, "Energy", 9);
  if (count(run.report.sublist("Problem"), "Inequality Multipliers") > 0)
    text << ", contact force " << scientific(accuracy, "Contact Force", 9) << " on "
         << counted(accuracy, "Active Contact Nodes", "closed node");
  text << '\n';
}

std::string rounded(const ParameterList& list, const char* name) {
  std::ostringstream text;
  text << std::setprecision(5) << list.get<double>(name);
  return text.str();
}

/// ", resultant 256.76" where it is another thing than the sum of the nodes' forces: these turn with the
/// surface, and their resultant is what a load holds.
std::string resultantOf(const ParameterList& contact) {
  constexpr double alike = 0.02;
  const auto& force = contact.get<Teuchos::Array<double>>("Resultant");
  const double sum = contact.get<double>("Force"), resultant = std::hypot(force[0], force[1], force[2]);
  if (std::abs(sum - resultant) <= alike * std::abs(sum))
    return "";
  std::ostringstream text;
  text << std::setprecision(5) << ", resultant " << resultant;
  return text.str();
}

/// One line a list, the first ones only if there are many. `line` adds what a list says.
template <class Line>
void describeEach(std::ostream& text, const ParameterList& lists, const std::string& label, Line line) {
  constexpr int most = 8;
  int number = 0;
  for (auto entry = lists.begin(); entry != lists.end(); ++entry)
    if (++number <= most) {
      text << "  " << std::left << std::setw(12) << label << lists.name(entry) << ": ";
      line(Teuchos::getValue<ParameterList>(lists.entry(entry)));
      text << '\n';
    }
  if (number > most)
    text << "              and " << number - most << " more in the report\n";
}

/// What a user should know of a contact or joint beside its numbers.
void addNotes(std::ostream& text, const ParameterList& list) {
  constexpr double balanced = 1e-3;
  const std::string indent = "\n                ";
  if (list.isParameter("Note"))
    text << indent << list.get<std::string>("Note");
  if (list.isParameter("Bent Nodes"))
    text << indent << "a surface bends sharply at " << counted(list, "Bent Nodes", "contact node")
         << " more than one face of which meets the other side; the normal there is their mean: give the "
            "faces "
            "contacts of their own";
  if (list.isParameter("Moment Imbalance") && list.get<double>("Moment Imbalance") > balanced)
    text << indent << "the forces on both sides are out of balance by "
         << percent(list.get<double>("Moment Imbalance")) << " in moment: they do not lie across each other";
}

void describeResults(std::ostream& text, const SceneRun& run) {
  if (run.report.isSublist("Body"))
    describeEach(text, run.report.sublist("Body"), "body", [&](const ParameterList& body) {
      text << "largest displacement " << rounded(body, "Largest Displacement")
           << ", largest von Mises stress " << rounded(body, "Largest von Mises Stress");
    });
  if (run.report.isSublist("Contact"))
    describeEach(text, run.report.sublist("Contact"), "contact", [&](const ParameterList& contact) {
      text << count(contact, "Active Nodes") << " of " << counted(contact, "Candidates", "node")
           << " closed, area " << rounded(contact, "Contact Area") << ", force " << rounded(contact, "Force")
           << resultantOf(contact) << ", largest pressure " << rounded(contact, "Largest Pressure");
      if (contact.isParameter("Largest Penetration"))
        text << ", penetration " << rounded(contact, "Largest Penetration");
      if (contact.isParameter("Coupling"))
        text << "; " << contact.get<std::string>("Coupling");
      addNotes(text, contact);
    });
  if (run.report.isSublist("Tied"))
    describeEach(text, run.report.sublist("Tied"), "tied", [&](const ParameterList& tie) {
      const auto& force = tie.get<Teuchos::Array<double>>("Resultant");
      text << counted(tie, "Nodes", "node") << ", force " << std::setprecision(5)
           << std::hypot(force[0], force[1], force[2]) << ", largest traction "
           << rounded(tie, "Largest Traction") << "; " << tie.get<std::string>("Coupling");
      addNotes(text, tie);
    });
}

void describeCosts(std::ostream& text, const SceneRun& run) {
  const ParameterList& time = run.report.sublist("Time");
  const ParameterList& memory = run.report.sublist("Memory");
  const bool isLastOfMany = run.report.isSublist("Levels");
  text << "  time        " << (isLastOfMany ? "last mesh: " : "") << "assembly " << seconds(time, "Assembly")
       << ", setup " << seconds(time, "Setup");
  if (time.isParameter("Start"))
    text << ", start " << seconds(time, "Start");
  text << ", solve " << seconds(time, "Solve") << ", recovery " << seconds(time, "Recovery");
  if (time.isParameter("Error Estimate"))
    text << ", error estimate " << seconds(time, "Error Estimate");
  if (time.isParameter("Output"))
    text << ", output " << seconds(time, "Output");
  if (time.isParameter("Total"))
    text << (isLastOfMany ? "; total of all meshes " : "; total ") << seconds(time, "Total");
  text << "\n  memory      " << bytes(memory.get<double>("Peak Bytes"))
       << " at most over all ranks, of which factors " << bytes(memory.get<double>("Factor Bytes")) << '\n';
}

} // namespace

std::string summary(const SceneRun& run) {
  std::ostringstream text;
  describeProblem(text, run);
  describeSolution(text, run);
  describeAccuracy(text, run);
  describeResults(text, run);
  describeCosts(text, run);
  const ParameterList& status = run.report.sublist("Status");
  text << "  status      " << status.get<std::string>("Status") << ": " << status.get<std::string>("Reason")
       << '\n';
  return text.str();
}

std::string describe(const accuracy::MeshResult& mesh) {
  const double algebraic = std::isfinite(mesh.algebraic) ? mesh.algebraic : 0;
  const double absolute = std::hypot(mesh.discretisation, algebraic);
  const double scale = absolute > 0 ? mesh.relative() / absolute : 0;
  std::ostringstream text;
  text << "  mesh        order " << mesh.order << ", " << counted(mesh.unknowns, "primal unknown") << ", "
       << counted(mesh.multiplications, "product") << " with F, " << std::setprecision(2) << mesh.seconds
       << " s: ";
  if (mesh.quantity) {
    text << valueWithBar(mesh.quantity->value, mesh.quantity->discretisation + mesh.quantity->algebraic)
         << '\n';
    return text.str();
  }
  text << "estimated error " << percent(mesh.relative()) << " (" << percent(scale * mesh.discretisation)
       << " of the mesh, "
       << (std::isfinite(mesh.algebraic) ? percent(scale * algebraic) + " of the iteration"
                                         : "that of the iteration not measured")
       << ")\n";
  return text.str();
}

} // namespace epafi::drivers
