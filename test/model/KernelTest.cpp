// The rigid modes that geometry tells, against the matrices of the subdomains.

#include "epafi/base/Errors.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"
#include "epafi/model/Decompose.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace epafi::model {
namespace {

scene::Scene block(int dimension) {
  scene::Scene scene;
  scene::Body body;
  body.name = "block";
  body.physics = dimension == 3 ? fem::Physics::elasticity3d : fem::Physics::planeStrain;
  body.mesh.box = {{100, 50, 7}, {101, 51, 8}};
  body.mesh.elements = {4, 4, dimension == 3 ? 4 : 0};
  scene.bodies = {body};
  return scene;
}

TEST(KernelTest, AModeThatTheMatrixDoesNotKnowIsAFault) {
  for (const int dimension : {2, 3}) {
    const scene::Scene scene = block(dimension);
    const std::vector<BodyLayout> bodies = layoutBodies(scene, *Tpetra::getDefaultComm());
    const auto model = makeModel(scene.bodies[0], *bodies[0].mesh);
    for (int part = 0; part < bodies[0].partition->numParts(); ++part) {
      const fem::AssembledSubdomain assembled = fem::assemble(*model, bodies[0].partition->elementsOf(part));
      ASSERT_EQ(assembled.kernel.cols(), dimension == 3 ? 6 : 3);
      for (const double error : {0.0, 1e-12, 1e-3, 1.0}) {
        Eigen::MatrixXd mistaken = assembled.kernel;
        for (Eigen::Index i = 0; i < mistaken.rows(); i += 2)
          mistaken.row(i) *= 1 + error;
        if (error < 1e-6) {
          EXPECT_NO_THROW(requireKernel(assembled.stiffness, mistaken, "block"));
        } else {
          EXPECT_THROW(requireKernel(assembled.stiffness, mistaken, "block"), Error) << error;
        }
      }
    }
  }
}

// A subdomain that is held everywhere, as a rigid block under a deck's contact is, has no row; one that is
// held enough has no mode.
TEST(KernelTest, WhatHasNoRowOrNoModeHasNoFault) {
  EXPECT_NO_THROW(requireKernel(decomposition::SparseMatrix(0, 0), Eigen::MatrixXd(0, 6), "block"));
  EXPECT_NO_THROW(requireKernel(decomposition::SparseMatrix(0, 0), Eigen::MatrixXd(0, 0), "block"));
  EXPECT_NO_THROW(requireKernel(decomposition::SparseMatrix(3, 3), Eigen::MatrixXd(3, 0), "block"));
}

} // namespace
} // namespace epafi::model
