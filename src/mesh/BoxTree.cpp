#include "epafi/mesh/BoxTree.hpp"

#define BOOST_ALLOW_DEPRECATED_HEADERS // what its own headers include
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <utility>

namespace epafi::mesh {
namespace {

namespace geometry = boost::geometry;

using TreePoint = geometry::model::point<double, 3, geometry::cs::cartesian>;
using TreeBox = geometry::model::box<TreePoint>;
using NumberedBox = std::pair<TreeBox, std::size_t>;

TreePoint toTree(const Point& point) {
  return {point[0], point[1], point[2]};
}

TreeBox toTree(const BoxTree::Box& box) {
  return {toTree(box[0]), toTree(box[1])};
}

using Boxes = geometry::index::rtree<NumberedBox, geometry::index::quadratic<16>>;

template <class Things>
Boxes treeOf(const Things& things) {
  std::vector<NumberedBox> entries;
  for (std::size_t i = 0; i < things.size(); ++i)
    entries.emplace_back(geometry::return_envelope<TreeBox>(toTree(things[i])), i);
  return Boxes(entries);
}

template <class Query>
void find(const Boxes& boxes, const Query& query, std::vector<std::size_t>& found) {
  found.clear();
  for (auto entry = boxes.qbegin(query); entry != boxes.qend(); ++entry)
    found.push_back(entry->second);
  std::sort(found.begin(), found.end());
}

} // namespace

struct BoxTree::Tree {
  Boxes boxes;
};

BoxTree::BoxTree(std::span<const Box> boxes) : tree_(std::make_unique<const Tree>(Tree{treeOf(boxes)})) {}

BoxTree::BoxTree(std::span<const Point> points) : tree_(std::make_unique<const Tree>(Tree{treeOf(points)})) {}

BoxTree::~BoxTree() = default;

void BoxTree::meeting(const Box& box, std::vector<std::size_t>& found) const {
  find(tree_->boxes, geometry::index::intersects(toTree(box)), found);
}

void BoxTree::nearest(const Point& point, std::size_t most, std::vector<std::size_t>& found) const {
  find(tree_->boxes, geometry::index::nearest(toTree(point), static_cast<unsigned>(most)), found);
}

} // namespace epafi::mesh
