#include "epafi/fem/Q1Element.hpp"
#include "epafi/scene/Scene.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

TEST(Q1ElementTest, StiffnessOfTheSquareIsTheTextbooksOne) {
  Eigen::Matrix4d expected;
  expected << 4, -1, -2, -1, //
      -1, 4, -1, -2,         //
      -2, -1, 4, -1,         //
      -1, -2, -1, 4;
  EXPECT_LT((6 * membraneStiffness(0.25, 0.25) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Q1ElementTest, EnergyOfBilinearFieldsIsExact) {
  const double hx = 0.5, hy = 2;
  const Eigen::Matrix4d k = membraneStiffness(hx, hy);
  EXPECT_EQ(k, k.transpose());
  const Eigen::Vector4d x(0, hx, hx, 0), y(0, 0, hy, hy), xy(0, 0, hx * hy, 0);
  EXPECT_NEAR(x.dot(k * x), hx * hy, 1e-14); // ∫1
  EXPECT_NEAR(y.dot(k * y), hx * hy, 1e-14);
  EXPECT_NEAR(x.dot(k * y), 0, 1e-14);
  EXPECT_NEAR(xy.dot(k * xy), hx * hy * (hx * hx + hy * hy) / 3, 1e-13); // ∫x² + y²
  EXPECT_LT((k * Eigen::Vector4d::Ones()).norm(), 1e-14);
}

/// Load of the element on its part inside a box.
Eigen::Vector4d loadIn(const scene::Rectangle& element, const scene::Rectangle& box) {
  return membraneLoad(segmentLoad(element.x0, element.x1, box.x0, box.x1),
                      segmentLoad(element.y0, element.y1, box.y0, box.y1));
}

TEST(Q1ElementTest, LoadIsExactForBoxesThatCutTheElement) {
  const scene::Rectangle element{1, 2, 0, 2}, box{1.5, 7, -3, 0.5};
  const Eigen::Vector4d load = loadIn(element, box);
  EXPECT_NEAR(load.sum(), 0.5 * 0.5, 1e-15);                   // area in common
  EXPECT_NEAR(load[1] + load[2], 0.5 * 0.5 * 0.75, 1e-15);     // ∫(x − 1)
  EXPECT_NEAR(load[2] + load[3], 0.5 * 0.5 * 0.25 / 2, 1e-15); // ∫y/2
  EXPECT_EQ(loadIn(element, {2, 3, 0, 2}).norm(), 0);          // only an edge in common
  EXPECT_LT((loadIn(element, {0, 9, -9, 9}) - Eigen::Vector4d::Constant(0.5)).norm(), 1e-15);
}

} // namespace
} // namespace epafi::fem
