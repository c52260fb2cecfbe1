#include "epafi/linear/BoundaryStiffness.hpp"

#include <utility>

namespace epafi::linear {

BoundaryStiffness::BoundaryStiffness(const decomposition::DecomposedProblem& problem,
                                     std::shared_ptr<const fetidp::GeneralizedInverse> inverse)
    : inverse_(std::move(inverse)), boundary_(problem.subdomains.size()) {
  for (const fetidp::SubdomainGroup& group : inverse_->groups()) {
    const fetidp::CondensedSubdomain& condensed = group.condensed();
    blocks_.push_back(group.boundaryStiffness(direct::SymmetricBlock::Precision::full));
    const std::vector<int>& remainders = problem.subdomains[group.members().front()].remainderUnknowns;
    for (const std::size_t member : group.members())
      for (const int position : condensed.interface().boundary)
        boundary_[member].push_back(remainders[static_cast<std::size_t>(position)]);
  }
}

void BoundaryStiffness::apply(const SubdomainVectors& u, SubdomainVectors& forces) const {
  forces.resize(u.size());
  const auto groups = inverse_->groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto members = groups[g].members();
    const std::vector<int>& boundary = boundary_[members.front()];
    const Eigen::Index columns = u[members.front()].cols();
    input_.resize(static_cast<Eigen::Index>(boundary.size()),
                  static_cast<Eigen::Index>(members.size()) * columns);
    output_.resizeLike(input_);
    Eigen::Index place = 0;
    for (const std::size_t member : members) {
      input_.middleCols(place, columns) = u[member](boundary, Eigen::all);
      place += columns;
    }
    blocks_[g]->apply(input_, output_);
    place = 0;
    for (const std::size_t member : members) {
      forces[member].setZero(u[member].rows(), columns);
      forces[member](boundary, Eigen::all) = output_.middleCols(place, columns);
      place += columns;
    }
  }
}

std::size_t BoundaryStiffness::bytes() const {
  std::size_t sum = 0;
  for (const auto& block : blocks_)
    sum += block->bytes();
  return sum;
}

} // namespace epafi::linear
