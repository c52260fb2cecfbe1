#include "epafi/model/ContactGroups.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/contact/SurfaceNodes.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/model/ContactSurfaces.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

namespace epafi::model {
namespace {

using Terms = scene::SurfaceContact;
using Kind = Terms::Kind;
using Eigen::Vector3d;

/// What of a surface decides whether it goes on in another one.
struct Side {
  std::set<std::vector<GlobalOrdinal>> facets; ///< nodes, ascending
  std::map<GlobalOrdinal, Vector3d> normals;   ///< at nodes, by area
};

Side sideOf(const Terms& terms, const BodyLayout& body, const std::string& name) {
  const mesh::Surface surface = surfaceOf(terms, body, name);
  Side side;
  std::vector<Point> points;
  for (std::size_t f = 0; f < surface.numFacets(); ++f) {
    const auto nodes = surface.facet(f);
    body.mesh->pointsAt(nodes, points);
    const Vector3d normal = mesh::areaVector(surface.typeOf(f), points);
    for (const GlobalOrdinal node : nodes)
      side.normals.try_emplace(node, Vector3d::Zero()).first->second += normal;
    std::vector<GlobalOrdinal> key(nodes.begin(), nodes.end());
    std::sort(key.begin(), key.end());
    side.facets.insert(std::move(key));
  }
  return side;
}

bool contains(const Side& whole, const Side& part) {
  return std::includes(whole.facets.begin(), whole.facets.end(), part.facets.begin(), part.facets.end());
}

/// How two surfaces of a body meet.
enum class Meeting { nowhere, smoothly, sharply };

Meeting meetingOf(const Side& a, const Side& b) {
  Meeting meeting = Meeting::nowhere;
  for (const auto& [node, normal] : a.normals)
    if (const auto other = b.normals.find(node); other != b.normals.end()) {
      meeting = Meeting::smoothly;
      if (normal.dot(other->second) < contact::sharpBend * normal.norm() * other->second.norm())
        return Meeting::sharply;
    }
  return meeting;
}

/// Whether obstacles stop a node alike.
bool areSame(const scene::Obstacle& a, const scene::Obstacle& b) {
  const auto asVector = [](const Vector3& x) { return Vector3d(x[0], x[1], x[2]); };
  const Vector3d apart = asVector(b.point) - asVector(a.point);
  constexpr double same = 1e-12;
  const double size = asVector(a.point).norm() + asVector(b.point).norm() + std::abs(a.radius);
  if (a.kind != b.kind)
    return false;
  if (a.kind == scene::Obstacle::Kind::plane)
    return (asVector(a.normal) - asVector(b.normal)).norm() <= same &&
           std::abs(asVector(a.normal).dot(apart)) <= same * size;
  const Vector3d axis = asVector(a.normal);
  const bool isCylinder = a.kind == scene::Obstacle::Kind::cylinder;
  return (isCylinder ? axis.cross(apart) : apart).norm() <= same * size &&
         (!isCylinder || axis.cross(asVector(b.normal)).norm() <= same) && a.isHollow == b.isHollow &&
         std::abs(a.radius - b.radius) <= same * size;
}

class Groups {
public:
  Groups(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) : scene_(scene), bodies_(bodies) {}

  void add(int number);
  [[nodiscard]] std::vector<ContactGroup> take();

private:
  /// One of the scene's contacts, its bodies as in its group.
  struct Member {
    Terms terms;
    Side first, second; ///< second: of an obstacle empty
  };

  [[nodiscard]] Member memberOf(const Terms& terms) const;
  [[nodiscard]] static bool haveSameBodies(const Terms& a, const Terms& b);
  void requireNew(const Member& old, const Member& added) const;
  [[nodiscard]] static bool bringsFacets(std::span<const Member> members, const Member& added,
                                         Side Member::*side);
  void requireApart(Member added) const;
  [[nodiscard]] bool joins(const std::vector<Member>& members, const Member& added) const;
  static void exchange(Member& member);

  const scene::Scene& scene_;
  const std::vector<BodyLayout>& bodies_;
  std::vector<ContactGroup> groups_;
  std::vector<std::vector<Member>> members_;
};

Groups::Member Groups::memberOf(const Terms& terms) const {
  Member member{terms, {}, {}};
  member.first = sideOf(terms, bodies_[terms.first], terms.firstSurface);
  if (terms.second >= 0)
    member.second = sideOf(terms, bodies_[terms.second], terms.secondSurface);
  return member;
}

void Groups::exchange(Member& member) {
  Terms& terms = member.terms;
  std::swap(terms.first, terms.second);
  std::swap(terms.firstSurface, terms.secondSurface);
  if (terms.multipliers != Terms::Side::automatic)
    terms.multipliers = terms.multipliers == Terms::Side::first ? Terms::Side::second : Terms::Side::first;
  std::swap(member.first, member.second);
}

bool Groups::haveSameBodies(const Terms& a, const Terms& b) {
  return a.second >= 0 ? std::minmax(a.first, a.second) == std::minmax(b.first, b.second)
                       : b.second < 0 && a.first == b.first && areSame(a.obstacle, b.obstacle);
}

/// Precondition: the same bodies in the same order.
void Groups::requireNew(const Member& old, const Member& added) const {
  const auto isIn = [](const Member& whole, const Member& part) {
    return contains(whole.first, part.first) && contains(whole.second, part.second);
  };
  if (old.terms.kind == added.terms.kind && old.terms.gap == added.terms.gap &&
      old.terms.adjust == added.terms.adjust && old.terms.adjustNodes == added.terms.adjustNodes &&
      old.terms.distance == added.terms.distance && (isIn(old, added) || isIn(added, old))) {
    const bool isAddedLess = isIn(old, added);
    throw InputError(
        "contact '" + (isAddedLess ? added : old).terms.name + "' says nothing that contact '" +
        (isAddedLess ? old : added).terms.name +
        "' does not say: surfaces of the same bodies that lie within its own; remove one of them");
  }
}

/// Whether a surface of one more contact has facets that those of the others have not.
bool Groups::bringsFacets(std::span<const Member> members, const Member& added, Side Member::*side) {
  const auto& own = (added.*side).facets;
  return std::any_of(own.begin(), own.end(), [&](const auto& facet) {
    return std::none_of(members.begin(), members.end(),
                        [&](const Member& member) { return (member.*side).facets.contains(facet); });
  });
}

/// Whether one more contact goes on in those of a group, seen from the first bodies. Precondition: the same
/// bodies in the same order.
bool Groups::joins(const std::vector<Member>& members, const Member& added) const {
  const Terms &its = members.front().terms, &own = added.terms;
  if (its.preload || own.preload || its.kind != own.kind ||
      (own.kind == Kind::tied && (own.stiffness > 0) != (its.stiffness > 0)) || its.gap != own.gap ||
      its.adjust != own.adjust || its.adjustNodes != own.adjustNodes || its.distance != own.distance ||
      its.coupling != own.coupling || its.multipliers != own.multipliers)
    return false;
  const auto orderOf = [&](int body) { return mesh::orderOf(bodies_[body].mesh->cellType()); };
  const bool mayCarrySecond =
      own.second >= 0 && (own.multipliers == Terms::Side::second || orderOf(own.second) > orderOf(own.first));
  if (!bringsFacets(members, added, &Member::first) ||
      (mayCarrySecond && !bringsFacets(members, added, &Member::second)))
    return false;
  bool isConnected = false;
  for (const Member& member : members) {
    for (const Meeting meeting :
         {meetingOf(member.first, added.first), meetingOf(member.second, added.second)}) {
      if (meeting == Meeting::sharply)
        return false;
      isConnected = isConnected || meeting == Meeting::smoothly;
    }
  }
  return isConnected;
}

void Groups::add(int number) {
  Member added = memberOf(scene_.contacts[number]);
  for (std::size_t g = 0; g < groups_.size() && !isAlongEdges(scene_, added.terms); ++g) {
    std::vector<Member> members = members_[g];
    if (!haveSameBodies(members.front().terms, added.terms))
      continue;
    if (members.front().terms.first != added.terms.first)
      exchange(added);
    for (const Member& member : members)
      requireNew(member, added);
    if (!joins(members, added) && added.terms.second >= 0) {
      exchange(added);
      std::for_each(members.begin(), members.end(), [](Member& member) { exchange(member); });
    }
    if (!joins(members, added))
      continue;
    groups_[g].numbers.push_back(number);
    members.push_back(std::move(added));
    members_[g] = std::move(members);
    return;
  }
  added = memberOf(scene_.contacts[number]);
  requireApart(added);
  groups_.push_back({{number}, {}, true});
  members_.push_back({std::move(added)});
}

/// Contacts that are no group would share the forces of facets that both have on both sides in any way.
void Groups::requireApart(Member added) const {
  if (isAlongEdges(scene_, added.terms))
    return;
  const auto haveCommon = [](const Side& a, const Side& b) {
    return std::any_of(a.facets.begin(), a.facets.end(),
                       [&](const auto& facet) { return b.facets.contains(facet); });
  };
  for (const std::vector<Member>& members : members_)
    for (const Member& member : members) {
      const Terms& its = member.terms;
      if (!haveSameBodies(its, added.terms) || its.kind != added.terms.kind || its.gap != added.terms.gap)
        continue;
      if (its.first != added.terms.first)
        exchange(added);
      if (haveCommon(member.first, added.first) &&
          (its.second < 0 || haveCommon(member.second, added.second)))
        throw InputError(
            "contacts '" + its.name + "' and '" + added.terms.name +
            "' have facets in common on both sides, whose forces they could share in any way; name "
            "each facet in one of them");
    }
}

std::vector<ContactGroup> Groups::take() {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const std::vector<Member>& members = members_[g];
    for (std::size_t i = 0; i < members.size(); ++i) {
      groups_[g].terms.push_back(members[i].terms);
      groups_[g].mayEitherCarry =
          groups_[g].mayEitherCarry &&
          (i == 0 || bringsFacets(std::span(members).first(i), members[i], &Member::second));
    }
  }
  return std::move(groups_);
}

} // namespace

std::vector<ContactGroup> contactGroups(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  Groups groups(scene, bodies);
  for (int number = 0; number < std::ssize(scene.contacts); ++number)
    if (scene.contacts[number].isOn)
      groups.add(number);
  return groups.take();
}

} // namespace epafi::model
