#include "SceneLists.hpp"

#include "epafi/scene/SceneReader.hpp"

#include <string>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

ParameterList withEquation(const std::string& terms) {
  ParameterList list = cubeOnFloor();
  list.sublist("Equations").sublist("even").set("Terms", terms).set("Value", 0.5);
  return list;
}

TEST(EquationReaderTest, ReadsFactorsBodiesNodesAndComponents) {
  const scene::Scene scene = scene::readScene(withEquation("2.5 cube/a/b/X, -1e-3 cube/tip/Z"), "a.xml");
  ASSERT_EQ(scene.equations.size(), 1u);
  const scene::Equation& equation = scene.equations.front();
  EXPECT_EQ(equation.value, 0.5);
  ASSERT_EQ(equation.terms.size(), 2u);
  EXPECT_EQ(equation.terms[0].factor, 2.5);
  EXPECT_EQ(equation.terms[0].nodes, "a/b");
  EXPECT_EQ(equation.terms[0].component, 0);
  EXPECT_EQ(equation.terms[1].factor, -1e-3);
  EXPECT_EQ(equation.terms[1].component, 2);
}

TEST(EquationReaderTest, RefusesWhatIsNoTerm) {
  for (const auto& [terms, part] :
       {std::pair("", "Terms"), std::pair("cube/tip/X", "not of the form"),
        std::pair("0 cube/tip/X", "not of the form"), std::pair("nan cube/tip/X", "not of the form"),
        std::pair("1 cone/tip/X", "names no body"), std::pair("1 cube/tip/W", "X, Y or Z"),
        std::pair("1 cube/tip/", "X, Y or Z"), std::pair("1 X", "not of the form")})
    EXPECT_NE(
        refusal([&, text = std::string(terms)] { scene::readScene(withEquation(text), "a.xml"); }).find(part),
        std::string::npos)
        << terms;
}

} // namespace
