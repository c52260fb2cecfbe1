#include "epafi/contact/FacetTree.hpp"

#define BOOST_ALLOW_DEPRECATED_HEADERS // what its own headers include
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <utility>

namespace epafi::contact {
namespace {

namespace geometry = boost::geometry;

using TreePoint = geometry::model::point<double, 3, geometry::cs::cartesian>;
using TreeBox = geometry::model::box<TreePoint>;
using Entry = std::pair<TreeBox, std::size_t>;

TreeBox toTree(const FacetTree::Box& box) {
  return {{box[0][0], box[0][1], box[0][2]}, {box[1][0], box[1][1], box[1][2]}};
}

std::vector<Entry> entriesOf(std::span<const FacetTree::Box> boxes) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    entries.emplace_back(toTree(boxes[i]), i);
  return entries;
}

} // namespace

struct FacetTree::Tree {
  geometry::index::rtree<Entry, geometry::index::quadratic<16>> boxes;
};

FacetTree::FacetTree(std::span<const Box> boxes)
    : tree_(std::make_unique<const Tree>(Tree{decltype(Tree::boxes)(entriesOf(boxes))})) {}

FacetTree::~FacetTree() = default;

void FacetTree::meeting(const Box& box, std::vector<std::size_t>& found) const {
  found.clear();
  for (auto entry = tree_->boxes.qbegin(geometry::index::intersects(toTree(box)));
       entry != tree_->boxes.qend(); ++entry)
    found.push_back(entry->second);
  std::sort(found.begin(), found.end());
}

} // namespace epafi::contact
