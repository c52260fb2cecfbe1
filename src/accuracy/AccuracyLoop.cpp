#include "epafi/accuracy/AccuracyLoop.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <utility>

namespace epafi::accuracy {
namespace {

/// Of the target: what the mesh may use of it. The rest is the iteration's, and the estimate's own.
constexpr double meshShare = 0.9;
/// Of a quantity's first estimate: what the second mesh is to have at most, its root.
constexpr double confirming = 0.7;

/// θ: see refineToTarget(). \param next  its estimate not yet corrected
double measuredEffectivity(const MeshResult& last, const MeshResult& next, double otherwise) {
  constexpr double clear = 1.2, least = 0.4, most = 1.1;
  const double coarse = last.discretisation * last.effectivity, fine = next.discretisation; // η
  if (last.order != next.order || !(next.change > 0) || coarse < clear * fine)
    return otherwise;
  return std::clamp(std::sqrt(coarse * coarse - fine * fine) / next.change, least, most);
}

/// What is left of a quantity's error: Δ r/(1 − r) of the last change Δ, r by how much errors fall from mesh
/// to mesh: no more than the bars do, at least by 0.3; than so many unknowns more let expect, with three
/// quarters of the best rate; and than the last two changes where they go one way. Bars of meshes too coarse
/// to see what they miss are smaller. \param next  with a quantity, not yet among the meshes
double leftOfChange(const std::vector<MeshResult>& meshes, const MeshResult& next, int dimension) {
  constexpr double mostOfBars = 0.7, most = 0.9, shareOfRate = 0.75;
  const MeshResult& last = meshes.back();
  const double change = next.quantity->value - last.quantity->value;
  double ratio = last.quantity->discretisation > 0
                     ? std::min(mostOfBars, next.quantity->discretisation / last.quantity->discretisation)
                     : mostOfBars;
  if (last.order == next.order) {
    const double rate = shareOfRate * 2 * next.order / dimension;
    ratio = std::max(ratio,
                     std::pow(static_cast<double>(last.unknowns) / static_cast<double>(next.unknowns), rate));
  }
  if (meshes.size() > 1 && (meshes.end() - 2)->quantity && (meshes.end() - 2)->order == next.order) {
    const double before = last.quantity->value - (meshes.end() - 2)->quantity->value;
    if (before * change > 0)
      ratio = std::max(ratio, change / before);
  }
  ratio = std::min(ratio, most);
  return std::abs(change) * ratio / (1 - ratio);
}

/// Whether a bar is believed: another mesh with elements of the same order was there to look at.
bool isConfirmed(const std::vector<MeshResult>& meshes) {
  return !meshes.back().quantity || (meshes.size() > 1 && (meshes.end() - 2)->order == meshes.back().order);
}

/// Three digits, and from 1000 to 1e12 a whole number of as many.
std::string rounded(double value) {
  constexpr double whole = 1000, readable = 1e12;
  std::ostringstream text;
  if (value >= whole && value < readable) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    text << std::fixed << std::setprecision(0) << unit * std::round(value / unit);
  } else {
    text << std::setprecision(3) << value;
  }
  return text.str();
}

/// Says so if a quantity grows with every mesh by a power of the width that it looks at, as at a sharp edge;
/// else empty. On the way to a limit the powers fall to 0.
std::string endlessGrowth(const std::vector<MeshResult>& meshes) {
  // A force on one element after another has the power 1, in space 2.
  constexpr double least = 0.08, alike = 0.7, most = 0.9, finer = 1.3;
  constexpr std::size_t number = 3;
  if (meshes.size() < number)
    return "";
  std::ostringstream text;
  double before = 0;
  for (auto mesh = meshes.end() - number; mesh != meshes.end(); ++mesh) {
    if (!mesh->quantity || !(mesh->quantity->width > 0))
      return "";
    text << (mesh == meshes.end() - number ? "from " : " to ") << rounded(mesh->quantity->value);
    if (mesh == meshes.end() - number)
      continue;
    const double ratio = (mesh - 1)->quantity->width / mesh->quantity->width,
                 power = std::log(mesh->quantity->value / (mesh - 1)->quantity->value) / std::log(ratio);
    if (!(ratio >= finer) || !(power >= std::max(least, alike * before)) || power > most)
      return "";
    before = power;
  }
  return "it has no limit: it grows with every mesh, " + text.str() + ", as at a sharp edge";
}

/// What the elements' shares add up to, its root: as estimated, not corrected.
double estimated(const MeshResult& mesh) {
  if (!mesh.quantity)
    return mesh.effectivity * mesh.discretisation;
  const std::vector<double>& shares = mesh.elements.squared;
  return std::sqrt(std::accumulate(shares.begin(), shares.end(), 0.0));
}

/// What it is to be on the next mesh: less by as much as the error is to fall, of a quantity by its root.
double allowed(const MeshResult& mesh, double target) {
  const double share = meshShare * target;
  if (!mesh.quantity)
    return mesh.effectivity * share * std::hypot(mesh.energyNorm, mesh.discretisation);
  const double bar = mesh.quantity->discretisation;
  return bar > 0 ? estimated(mesh) * std::sqrt(share * std::abs(mesh.quantity->value) / bar) : 0;
}

/// By how much the last mesh missed what was expected of it: the next is asked for as much more.
double missedBy(const MeshResult& last, double expected) {
  constexpr double most = 1.15;
  return expected > 0 ? std::clamp(estimated(last) / expected, 1.0, most) : 1.0;
}

/// Unknowns at which order 1 reaches the target, as far as one mesh tells: its error falls with N^(-1/d),
/// that of a quantity with its square.
double unknownsOfOrderOne(const MeshResult& result, int dimension, double target) {
  const double power = result.quantity ? 0.5 * dimension : dimension;
  return static_cast<double>(result.unknowns) * std::pow(result.relative() / target, power);
}

/// Unknowns that order 2 has on a mesh of order 1: in the plane three edges, in space seven a corner.
double unknownsOfOrderTwo(const MeshResult& result, int dimension) {
  return static_cast<double>(result.unknowns) * (dimension == 2 ? 4 : 8);
}

/// Why the next mesh is not made; empty if it is.
std::string obstacle(const std::vector<MeshResult>& meshes, double growth, const LoopGoal& goal) {
  const MeshResult& last = meshes.back();
  std::ostringstream text;
  const double next = growth * static_cast<double>(last.unknowns);
  double seconds = 0;
  for (const MeshResult& mesh : meshes)
    seconds += mesh.seconds;
  if (!last.failure.empty())
    text << last.failure;
  else if (std::ssize(meshes) >= goal.maxMeshes)
    text << "no more than " << goal.maxMeshes << " meshes are allowed";
  else if (next > goal.maxUnknowns)
    text << "the next mesh would have some " << rounded(next) << " unknowns, and "
         << rounded(goal.maxUnknowns) << " are allowed";
  else if (seconds + growth * last.seconds > goal.maxSeconds)
    text << "the next mesh would take some " << rounded(growth * last.seconds) << " s after the "
         << rounded(seconds) << " s that the others took, and " << rounded(goal.maxSeconds)
         << " s are allowed";
  else if (growth * last.bytes > goal.maxBytes)
    text << "the next mesh would take some " << rounded(growth * last.bytes / 1e9) << " GB of memory, and "
         << rounded(goal.maxBytes / 1e9) << " GB are allowed";
  return text.str();
}

} // namespace

double MeshResult::relative() const {
  if (quantity) {
    const double bar = quantity->discretisation + quantity->algebraic;
    return bar > 0 ? bar / std::abs(quantity->value) : 0;
  }
  if (std::isinf(algebraic)) // nothing bounds it
    return algebraic;
  const double absolute = std::hypot(discretisation, std::isnan(algebraic) ? 0 : algebraic);
  const double whole = std::hypot(energyNorm, absolute);
  return whole > 0 ? absolute / whole : 0;
}

LoopResult refineToTarget(RefinableProblem& problem, const LoopGoal& goal,
                          const std::function<void(const MeshResult&)>& tell) {
  LoopResult result;
  const int dimension = problem.dimension();
  std::vector<LocalOrdinal> ancestors;
  const auto solve = [&](int order) -> const MeshResult& {
    MeshResult next = problem.solve(order);
    ElementErrors& elements = next.elements;
    if (!ancestors.empty())
      elements.orders = localOrders(result.meshes.back().elements, ancestors, elements.squared,
                                    elements.measures, dimension, next.order);
    else
      elements.orders.assign(elements.squared.size(), next.order);
    next.effectivity = problem.effectivity(next.order);
    if (!result.meshes.empty()) {
      MeshResult& before = result.meshes.back();
      next.effectivity = measuredEffectivity(
          before, next, before.order == next.order ? before.effectivity : next.effectivity);
      before.elements = {};
    }
    next.discretisation /= next.effectivity;
    if (next.quantity) {
      double& bar = next.quantity->discretisation;
      bar /= next.effectivity * next.effectivity;
      if (!result.meshes.empty() && result.meshes.back().quantity)
        bar = std::max(bar, leftOfChange(result.meshes, next, dimension));
    }
    result.meshes.push_back(std::move(next));
    if (tell)
      tell(result.meshes.back());
    const MeshResult& last = result.meshes.back();
    result.isMet = last.failure.empty() && last.relative() <= goal.target && isConfirmed(result.meshes);
    return last;
  };
  int order = goal.order == 0 ? 1 : goal.order;
  const MeshResult* last = &solve(order);
  if (goal.order == 0 && last->failure.empty()) {
    const double one = unknownsOfOrderOne(*last, dimension, goal.target),
                 two = unknownsOfOrderTwo(*last, dimension);
    std::ostringstream text;
    if (last->relative() <= goal.target)
      text << "elements of order 1 on the first mesh make no more error than is allowed";
    else if (one <= two)
      text << "order 1 needs some " << rounded(one) << " unknowns for it, order 2 " << rounded(two)
           << " on the first mesh";
    else
      text << "order 2, as order 1 would need some " << rounded(one) << " unknowns";
    result.choice = text.str();
    if (!result.isMet && one > two) {
      result.reason = obstacle(result.meshes, dimension == 2 ? 4 : 8, goal);
      if (!result.reason.empty())
        return result;
      order = 2;
      last = &solve(order);
    }
  }
  double expected = 0; // of the discretisation error, on the last mesh
  while (!result.isMet) {
    double error = allowed(*last, goal.target) / missedBy(*last, expected);
    if (!isConfirmed(result.meshes))
      error = std::min(error, confirming * estimated(*last));
    const WantedSizes wanted = problem.plan(*last, {.dimension = dimension, .error = error});
    expected = wanted.error;
    result.reason = endlessGrowth(result.meshes);
    result.isEndless = !result.reason.empty();
    if (!result.isEndless)
      result.reason = obstacle(result.meshes, std::max(1.0, wanted.growth), goal);
    constexpr double nothing = 1.001;
    const bool isFineEnough = result.reason.empty() && wanted.growth < nothing;
    if (isFineEnough && last->failure.empty() && last->relative() <= goal.target) {
      result.isMet = true; // no element adds to the bar, which no other mesh could confirm
      break;
    }
    if (isFineEnough)
      result.reason = "the mesh is fine enough, but the iteration is not; ask it for a smaller tolerance";
    if (!result.reason.empty())
      break;
    ancestors = problem.refine(wanted);
    last = &solve(order);
  }
  return result;
}

} // namespace epafi::accuracy
