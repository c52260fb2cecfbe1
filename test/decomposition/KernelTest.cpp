// The rigid modes that geometry tells, against the matrices of the subdomains.

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/Pieces.hpp"
#include "epafi/fem/SolidModel.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace epafi::decomposition {
namespace {

/// A solid that says of its modes what is not so by a given share.
class Mistaken final : public fem::BodyModel {
public:
  Mistaken(const scene::Solid& solid, const fem::Mesh& mesh, double error)
      : model_("block", solid, mesh), error_(error) {}

  [[nodiscard]] const fem::Mesh& mesh() const override { return model_.mesh(); }
  [[nodiscard]] int components() const override { return model_.components(); }
  [[nodiscard]] int kernelDimension() const override { return model_.kernelDimension(); }
  [[nodiscard]] double kernelValue(GlobalOrdinal node, int component, int mode) const override {
    return model_.kernelValue(node, component, mode) * (1 + error_ * static_cast<double>(node % 2));
  }
  [[nodiscard]] std::optional<double> prescribed(GlobalOrdinal node, int component) const override {
    return model_.prescribed(node, component);
  }
  void prescribed(std::span<const GlobalOrdinal> nodes,
                  std::vector<fem::PrescribedValue>& values) const override {
    model_.prescribed(nodes, values);
  }
  void kinds(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> kinds) const override {
    model_.kinds(elements, kinds);
  }
  void stiffness(GlobalOrdinal kind, Eigen::MatrixXd& stiffness) const override {
    model_.stiffness(kind, stiffness);
  }
  void loads(std::span<const GlobalOrdinal> elements, Eigen::MatrixXd& loads) const override {
    model_.loads(elements, loads);
  }

private:
  fem::SolidModel model_;
  double error_;
};

scene::Scene block(int dimension) {
  scene::Scene scene;
  scene::Body body;
  body.name = "block";
  scene::Solid solid;
  solid.physics = dimension == 3 ? scene::Physics::elasticity3d : scene::Physics::planeStrain;
  solid.mesh.box = {{100, 50, 7}, {101, 51, 8}};
  solid.mesh.elements = {4, 4, dimension == 3 ? 4 : 0};
  body.solid = solid;
  scene.bodies = {body};
  return scene;
}

TEST(KernelTest, AModeThatTheMatrixDoesNotKnowIsAFault) {
  for (const int dimension : {2, 3}) {
    const scene::Scene scene = block(dimension);
    const auto comm = Tpetra::getDefaultComm();
    const std::vector<BodyLayout> bodies = layoutBodies(scene, *comm);
    for (const double error : {0.0, 1e-12, 1e-3, 1.0}) {
      Layout layout{bodies, {}, bodies[0].partition->numParts()};
      layout.models.push_back(std::make_unique<Mistaken>(*scene.bodies[0].solid, *bodies[0].mesh, error));
      if (error < 1e-6) {
        EXPECT_FALSE(assemblePieces(layout, *comm).empty()); // four or eight parts for at most four ranks
      } else {
        EXPECT_THROW(assemblePieces(layout, *comm), Error) << error;
      }
    }
  }
}

} // namespace
} // namespace epafi::decomposition
