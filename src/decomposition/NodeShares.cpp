#include "epafi/decomposition/NodeShares.hpp"

#include "epafi/decomposition/SharedValues.hpp"

namespace epafi::decomposition {

NodeShares::NodeShares(const Outline& outline, const std::vector<PieceNode>& nodes,
                       const std::vector<Piece>& pieces, const RCP<const Comm>& comm) {
  std::vector<SharedNode> shared;
  for (const PieceNode& place : nodes) {
    const Piece& piece = pieces[place.piece];
    if (const auto k = piece.sharing.find(place.node);
        k && piece.isCrosspoint[place.node] == 0 &&
        numberOf_.try_emplace({place.piece, place.node}, shared.size()).second)
      shared.push_back({place.piece, *k});
  }
  const auto components = static_cast<std::size_t>(outline.bodies.front().components);
  Eigen::MatrixXd own(static_cast<Eigen::Index>(shared.size()), static_cast<Eigen::Index>(components));
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const Piece& piece = pieces[shared[i].piece];
    own.row(static_cast<Eigen::Index>(i)) =
        stiffnessOf(piece, piece.sharing.node(shared[i].place), components);
  }
  const std::vector<Eigen::MatrixXd> copies = valuesOfCopies(outline, pieces, shared, own, comm);
  for (std::size_t i = 0; i < shared.size(); ++i)
    shares_.emplace_back(own.row(static_cast<Eigen::Index>(i)).array() / copies[i].colwise().sum().array());
}

const Eigen::RowVectorXd* NodeShares::at(const PieceNode& node) const {
  const auto found = numberOf_.find({node.piece, node.node});
  return found == numberOf_.end() ? nullptr : &shares_[found->second];
}

} // namespace epafi::decomposition
