#pragma once

/// Subdomain matrices of element matrices that an application streams in, with the subdomain of each element.

#include "epafi/decomposition/SubdomainMatrix.hpp"

#include <Eigen/Core>

#include <map>
#include <span>
#include <unordered_map>
#include <vector>

namespace epafi::decomposition {

/// One element; e unknowns.
struct ElementMatrix {
  std::span<const GlobalOrdinal> unknowns; ///< e, global numbers as in SubdomainMatrix, none twice
  const Eigen::MatrixXd& coordinates;      ///< e × dimension: the place of each unknown's node
  const Eigen::MatrixXd& stiffness;        ///< e × e, symmetric
  const Eigen::VectorXd& load;             ///< e
};

/// Adds up the elements of this rank's subdomains. Nothing is kept of an element but its entries; nothing is
/// collective.
class ElementMatrices {
public:
  /// \param dimension   of space
  explicit ElementMatrices(int dimension) : dimension_(dimension) {}

  /// Adds an element to a subdomain. Precondition: all elements of a subdomain are added on one rank.
  /// \param subdomain  any number by which the application tells its subdomains apart
  /// \param body       index of the body, the same for all elements of a subdomain
  /// \throws InputError if the sizes do not fit, or for a second body in a subdomain.
  void add(int subdomain, const ElementMatrix& element, int body = 0);

  /// The subdomains added, in the order of their numbers; leaves none here. The entries of K^s are summed in
  /// the order in which elements came, as are the loads.
  std::vector<SubdomainMatrix> take();

private:
  struct Sum {
    int body = 0;
    std::unordered_map<GlobalOrdinal, int> place; ///< of an unknown
    std::vector<GlobalOrdinal> unknowns;
    std::vector<double> coordinates, load; ///< of each unknown
    std::vector<Eigen::Triplet<double>> entries;
  };

  int dimension_;
  std::map<int, Sum> sums_;
};

} // namespace epafi::decomposition
