#include "SceneRun.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_Time.hpp>

#include <iomanip>
#include <sstream>

namespace epafi::drivers {

Teuchos::ParameterList driverSchema() {
  Teuchos::ParameterList schema = scene::sceneSchema();
  schema.sublist("Solver", false, "How the problem is solved; the defaults suit most scenes.")
      .setParameters(ContactSolver::validParameters());
  return schema;
}

SceneRun solveScene(const scene::Scene& scene, const Teuchos::ParameterList& solverParameters,
                    const RCP<const Comm>& comm, qp::Observer* observer) {
  SceneRun run;
  run.started = Teuchos::Time::wallTime();
  run.scene = scene;
  run.solver = std::make_unique<ContactSolver>(solverParameters);
  run.decomposition = std::make_unique<decomposition::Decomposition>(decomposition::decompose(scene, comm));
  const double assembly = maxOverRanks(*comm, Teuchos::Time::wallTime() - run.started);
  run.solver->setup(run.decomposition->problem);
  run.solution = run.solver->solve(nullptr, observer);
  run.report = run.solver->reportList(run.solution);
  run.report.sublist("Time").set("Assembly", assembly);
  run.report.sublist("Problem").set("Title", scene.title);
  return run;
}

namespace {

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

std::string seconds(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(value < 1 ? 3 : 2) << value << " s";
  return text.str();
}

} // namespace

std::string summary(const SceneRun& run) {
  const Teuchos::ParameterList& problem = run.report.sublist("Problem");
  const Teuchos::ParameterList& algorithm = run.report.sublist("Algorithm");
  const Teuchos::ParameterList& iterations = run.report.sublist("Iterations");
  const Teuchos::ParameterList& accuracy = run.report.sublist("Accuracy");
  const Teuchos::ParameterList& time = run.report.sublist("Time");
  const Teuchos::ParameterList& memory = run.report.sublist("Memory");
  const Teuchos::ParameterList& status = run.report.sublist("Status");
  const auto count = [](const Teuchos::ParameterList& list, const char* name) {
    return std::to_string(list.isType<int>(name) ? list.get<int>(name) : list.get<GlobalOrdinal>(name));
  };
  std::ostringstream text;
  text << "  problem     " << count(problem, "Primal Dimension") << " primal unknowns in "
       << count(problem, "Subdomains") << " subdomains on " << count(problem, "Ranks") << " ranks, "
       << count(problem, "Crosspoints") << " crosspoints\n"
       << "              " << count(problem, "Dual Dimension")
       << " multipliers: " << count(problem, "Inequality Multipliers") << " of contact, "
       << count(problem, "Equality Multipliers") << " of gluing\n";
  std::string floating;
  for (const auto& body : run.decomposition->problem.bodies)
    if (body.kernelDimension > 0)
      floating += (floating.empty() ? "" : ", ") + body.name;
  text << "  floating    " << (floating.empty() ? "no body" : floating) << '\n'
       << "  algorithm   " << algorithm.get<std::string>("Name") << ": "
       << algorithm.get<std::string>("Reason") << '\n'
       << "              preconditioner " << algorithm.get<std::string>("Preconditioner")
       << ", subdomains by " << algorithm.get<std::string>("Subdomain Solver") << ", coarse problem by "
       << algorithm.get<std::string>("Coarse Solver") << '\n'
       << "  iterations  " << count(iterations, "Hessian Multiplications") << " products with F (and "
       << count(iterations, "Norm Estimate Multiplications")
       << " to estimate its norm): " << count(iterations, "CG Steps") << " CG + "
       << count(iterations, "Expansion Steps") << " expansion + " << count(iterations, "Proportioning Steps")
       << " proportioning steps, " << count(iterations, "Outer") << " outer\n";
  text << std::scientific << std::setprecision(2) << "  accuracy    projected gradient "
       << accuracy.get<double>("Relative Projected Gradient") << " (asked " << run.solver->tolerance()
       << "), feasibility " << accuracy.get<double>("Feasibility") << ", complementarity "
       << accuracy.get<double>("Complementarity");
  if (!floating.empty())
    text << ", equilibrium " << accuracy.get<double>("Equilibrium");
  text << '\n' << std::setprecision(9) << "  solution    energy " << accuracy.get<double>("Energy");
  if (problem.get<GlobalOrdinal>("Inequality Multipliers") > 0)
    text << ", contact force " << accuracy.get<double>("Contact Force") << " on "
         << count(accuracy, "Active Contact Nodes") << " closed nodes";
  text << "\n  time        assembly " << seconds(time.get<double>("Assembly")) << ", setup "
       << seconds(time.get<double>("Setup")) << ", solve " << seconds(time.get<double>("Solve"))
       << ", recovery " << seconds(time.get<double>("Recovery"));
  if (time.isParameter("Output"))
    text << ", output " << seconds(time.get<double>("Output"));
  if (time.isParameter("Total"))
    text << "; total " << seconds(time.get<double>("Total"));
  text << "\n  memory      " << bytes(memory.get<double>("Peak Bytes"))
       << " at most over all ranks, of which factors " << bytes(memory.get<double>("Factor Bytes")) << '\n'
       << "  status      " << status.get<std::string>("Status") << ": " << status.get<std::string>("Reason")
       << '\n';
  return text.str();
}

} // namespace epafi::drivers
