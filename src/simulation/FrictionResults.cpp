#include "epafi/simulation/FrictionResults.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/simulation/RowShares.hpp"

#include <Eigen/Geometry>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <unordered_map>

namespace epafi::simulation {
namespace {

using contact::ContactLayout;
using Eigen::Vector3d;

/// Forces and slips along the tangents of a contact's rows.
class RowTangents {
public:
  RowTangents(const SolvedScene& solved, const ContactLayout& contact)
      : contact_(contact), tangents_(contact), numTangents_(solved.decomposition.problem.components - 1) {}
  [[nodiscard]] int numTangents() const { return numTangents_; }
  /// Of a row, as its nodes are combined.
  [[nodiscard]] Vector3d at(std::size_t row, int k) const {
    Vector3d direction = Vector3d::Zero();
    contact_.forEachShare(
        row, [&](std::size_t place, double weight) { direction += weight * tangents_.at(place)[k]; });
    return direction;
  }
  /// Number of a row of friction among all multipliers.
  [[nodiscard]] GlobalOrdinal numberOf(const decomposition::DecomposedProblem& problem, std::size_t row,
                                       int k) const {
    return problem.numInequalities + numTangents_ * (contact_.firstFriction + row) + k;
  }

private:
  const ContactLayout& contact_;
  contact::ContactTangents tangents_;
  int numTangents_;
};

/// Of the layout's first body on the second one, as the scene's bodies are named.
double signOf(const SolvedScene& solved, const ContactLayout& contact) {
  return contact.firstBody == solved.scene.contacts[contact.number].first ? 1 : -1;
}

/// Values of multipliers, given by their numbers, one after the other. Collective.
std::vector<double> valuesOf(const Vector& vector, const std::vector<GlobalOrdinal>& numbers) {
  const RCP<const Map> map = mapInOrder(numbers, vector.getMap()->getComm());
  Vector here(map);
  here.doImport(vector, Import(vector.getMap(), map), Tpetra::INSERT);
  const auto values = here.getData();
  return {values.begin(), values.end()};
}

/// Sums of tangential forces, or of slacks, over the rows of nodes.
class TangentialSums {
public:
  /// Keeps references. \param rows  whose sums are asked for \param shares  what each of them consists of
  /// Collective.
  TangentialSums(const Vector& whole, const SolvedScene& solved, const RowTangents& tangents,
                 const std::vector<std::size_t>& rows, const RowShares& shares)
      : shares_(shares) {
    std::vector<std::size_t> near;
    for (const std::size_t row : rows)
      forEachRow(shares, row, [&](std::size_t other, double) { near.push_back(other); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<GlobalOrdinal> numbers;
    for (const std::size_t row : near)
      for (int k = 0; k < tangents.numTangents(); ++k)
        numbers.push_back(tangents.numberOf(solved.decomposition.problem, row, k));
    const std::vector<double> values = valuesOf(whole, numbers);
    std::size_t next = 0;
    for (const std::size_t row : near)
      for (int k = 0; k < tangents.numTangents(); ++k)
        values_.try_emplace(row, Vector3d::Zero()).first->second += values[next++] * tangents.at(row, k);
  }
  [[nodiscard]] Vector3d at(std::size_t row) const {
    Vector3d sum = Vector3d::Zero();
    forEachRow(shares_, row, [&](std::size_t other, double weight) { sum += weight * values_.at(other); });
    return sum;
  }

private:
  const RowShares& shares_;
  std::unordered_map<std::size_t, Vector3d> values_;
};

} // namespace

FrictionResult frictionResult(const SolvedScene& solved, const ContactLayout& contact,
                              const std::vector<double>& areas) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  const mesh::Mesh& mesh = *solved.decomposition.bodies[contact.firstBody].mesh;
  const RowTangents tangents(solved, contact);
  const auto force = solved.solution.multiplier->getData(), slack = solved.solution.slack->getData(),
             active = solved.solution.active->getData();
  enum Term : std::size_t {
    tangential,
    normal = 3,
    moment = 6,
    turning = 9,
    centre = 12,
    stick = 15,
    slip,
    open,
    work,
    numTerms
  };
  std::array<AccurateSum, numTerms> sums;
  double largest = 0;
  const double sign = signOf(solved, contact);
  for (const decomposition::FrictionNode& node : problem.frictionNodes) {
    const GlobalOrdinal place = problem.numberOf(node.contact) - contact.firstRow;
    if (place < 0 || place >= contact.numRows())
      continue;
    const std::size_t row = place;
    const double portion = contact.portion(row);
    Vector3d along = Vector3d::Zero(), slipped = Vector3d::Zero();
    for (int k = 0; k < tangents.numTangents(); ++k) {
      along += force[node.firstTangent + k] * tangents.at(row, k);
      slipped -= slack[node.firstTangent + k] * tangents.at(row, k);
      sums[work].add(-portion * force[node.firstTangent + k] * slack[node.firstTangent + k]);
    }
    const Vector3d point(mesh.point(contact.firstNodes[row]).data()),
        pressing = force[node.contact] * contact.spatialDirectionOf(row);
    const Vector3d both = point.cross(pressing + along), alone = point.cross(along);
    for (Eigen::Index d = 0; d < 3; ++d) {
      if (solved.isOfRevolution() && d != 1)
        continue; // what goes round balances itself
      sums[tangential + d].add(sign * portion * along[d]);
      sums[normal + d].add(sign * portion * pressing[d]);
      sums[moment + d].add(sign * portion * both[d]);
      sums[turning + d].add(sign * portion * alone[d]);
      sums[centre + d].add(portion > 0 ? areas[row] * point[d] : 0);
    }
    if (portion > 0)
      sums[active[node.contact] < 0.5        ? open
           : active[node.firstTangent] > 0.5 ? stick
                                             : slip]
          .add(areas[row]);
    if (active[node.contact] > 0.5 && portion > 0)
      largest = std::max(largest, slipped.norm());
  }
  sumOverRanks(solved.comm(), sums);
  FrictionResult result;
  const auto three = [&](Term first) {
    return Vector3d(sums[first].value(), sums[first + 1].value(), sums[first + 2].value());
  };
  const auto entered = [](const Vector3d& values) {
    return std::array<double, 3>{values[0], values[1], values[2]};
  };
  result.stickArea = sums[stick].value();
  result.slipArea = sums[slip].value();
  result.openArea = sums[open].value();
  const double area = result.stickArea + result.slipArea + result.openArea;
  const Vector3d middle = area > 0 ? Vector3d(three(centre) / area) : Vector3d::Zero();
  result.tangentialForce = entered(three(tangential));
  result.moment = entered(three(moment));
  result.tangentialMoment = entered(three(turning));
  result.centre = entered(middle);
  result.centreMoment = entered(three(moment) - middle.cross(three(normal) + three(tangential)));
  result.centreTangential = entered(three(turning) - middle.cross(three(tangential)));
  result.dissipation = sums[work].value();
  result.largestSlip = maxOverRanks(solved.comm(), largest);
  return result;
}

FrictionFields frictionFields(const SolvedScene& solved, const ContactLayout& contact) {
  const decomposition::DecomposedProblem& problem = solved.decomposition.problem;
  const RowTangents tangents(solved, contact);
  const std::vector<std::size_t> own = contact.ownRows();
  const RowRange slab = evenShare(own.size(), solved.comm());
  const std::vector<std::size_t> rows(own.begin() + slab.first, own.begin() + slab.first + slab.count);
  std::vector<GlobalOrdinal> normals, firsts;
  for (const std::size_t row : rows) {
    normals.push_back(contact.firstRow + row);
    firsts.push_back(tangents.numberOf(problem, row, 0));
  }
  // as those of the pressure and of the gap are (ContactState)
  const RowShares around = sharesOfMeans(contact), toNodes = sharesOfSlacks(contact);
  const TangentialSums forces(*solved.solution.multiplier, solved, tangents, rows, around),
      slacks(*solved.solution.slack, solved, tangents, rows, toNodes);
  const std::vector<double> sticks = valuesOf(*solved.solution.active, firsts),
                            closed = valuesOf(*solved.solution.active, normals);
  FrictionFields fields;
  const double sign = signOf(solved, contact);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double area = 0;
    forEachRow(around, rows[i], [&](std::size_t row, double weight) { area += weight * contact.areas[row]; });
    const Vector3d traction = sign / area * forces.at(rows[i]), slip = -sign * slacks.at(rows[i]);
    fields.traction.insert(fields.traction.end(), traction.begin(), traction.end());
    fields.slip.insert(fields.slip.end(), slip.begin(), slip.end());
    const FrictionState state = closed[i] <= 0.5  ? FrictionState::open
                                : sticks[i] > 0.5 ? FrictionState::stick
                                                  : FrictionState::slip;
    fields.state.push_back(static_cast<int>(state));
  }
  return fields;
}

} // namespace epafi::simulation
