#include "epafi/linear/NodalBasis.hpp"

namespace epafi::linear {

using decomposition::Average;
using decomposition::Subdomain;

void toUnknowns(const Subdomain& subdomain, Eigen::MatrixXd& u) {
  for (const Average& average : subdomain.averages) {
    for (const int other : average.others)
      u.row(average.carrier) += u.row(other);
    u.row(average.carrier) /= static_cast<double>(average.others.size() + 1); // a
    for (const int other : average.others)
      u.row(other) -= u.row(average.carrier); // ũ_i = u_i − a
  }
}

void toValues(const Subdomain& subdomain, Eigen::MatrixXd& u) {
  if (subdomain.averages.empty())
    return;
  for (Eigen::Index j = 0; j < u.cols(); ++j)
    decomposition::toNodalValues(subdomain, u.col(j));
}

void toForcesOfUnknowns(const Subdomain& subdomain, Eigen::MatrixXd& f) {
  for (const Average& average : subdomain.averages)
    for (Eigen::Index j = 0; j < f.cols(); ++j) {
      const double atCarrier = f(average.carrier, j);
      for (const int other : average.others) {
        f(average.carrier, j) += f(other, j); // Σ f_i, the force that goes with a
        f(other, j) -= atCarrier;
      }
    }
}

void toForcesOfValues(const Subdomain& subdomain, Eigen::MatrixXd& f) {
  for (const Average& average : subdomain.averages) {
    for (const int other : average.others)
      f.row(average.carrier) -= f.row(other);
    f.row(average.carrier) /= static_cast<double>(average.others.size() + 1);
    for (const int other : average.others)
      f.row(other) += f.row(average.carrier);
  }
}

} // namespace epafi::linear
