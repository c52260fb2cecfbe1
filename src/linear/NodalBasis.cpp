#include "epafi/linear/NodalBasis.hpp"

namespace epafi::linear {

using decomposition::Average;
using decomposition::Subdomain;

void toUnknowns(const Subdomain& subdomain, Eigen::MatrixXd& u) {
  for (const Average& average : subdomain.averages)
    for (Eigen::Index j = 0; j < u.cols(); ++j) {
      double mean = u(average.carrier, j);
      for (const int other : average.others)
        mean += u(other, j);
      mean /= static_cast<double>(average.others.size() + 1);
      u(average.carrier, j) = mean; // a
      for (const int other : average.others)
        u(other, j) -= mean; // ũ_i = u_i − a
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
  for (const Average& average : subdomain.averages)
    for (Eigen::Index j = 0; j < f.cols(); ++j) {
      double atCarrier = f(average.carrier, j);
      for (const int other : average.others)
        atCarrier -= f(other, j);
      atCarrier /= static_cast<double>(average.others.size() + 1);
      f(average.carrier, j) = atCarrier;
      for (const int other : average.others)
        f(other, j) += atCarrier;
    }
}

} // namespace epafi::linear
