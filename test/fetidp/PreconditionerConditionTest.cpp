#include "Preconditioned.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace epafi::fetidp {
namespace {

TEST(PreconditionerConditionTest, Measure) {
  for (const bool coercive : {true, false})
    for (const Type type : {Type::lumped, Type::dirichlet})
      for (const Scaling scaling : {Scaling::multiplicity, Scaling::stiffness})
        for (const int cuts : {1, 2, 4, 8})
          for (const int elements : {2, 4, 8, 16}) {
            if (cuts * elements > 32)
              continue;
            const double condition = conditionNumber(Preconditioned(
                twoMembranes(coercive, cuts * elements, grid(cuts, cuts)), {type, scaling, false}));
            std::cout << coercive << ' ' << describe({type, scaling, false}) << ' ' << cuts << ' ' << elements
                      << ": " << condition << std::endl;
          }
  for (const ContactCase& c : hardCases())
    for (const auto& p : allPreconditioners(false))
      std::cout << c.name << "; " << describe(p) << ": " << conditionNumber(Preconditioned(c.scene, p)) << std::endl;
  for (const bool coercive : {true, false}) 
    for (int parts : {3, 7, 16}) 
    for (const auto& p : allPreconditioners(false))
      std::cout << coercive << " metis " << parts << "; " << describe(p) << ": " << conditionNumber(Preconditioned(twoMembranes(coercive, 16, metis(parts)), p)) << std::endl;
}

} // namespace
} // namespace epafi::fetidp
