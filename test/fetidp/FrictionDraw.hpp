#pragma once

/// Small scenes with friction drawn from a seed: blocks and cubes that are held, slide, or lie on a floor or
/// on each other, with either law of friction.

#include "epafi/scene/Scene.hpp"

#include <cmath>
#include <random>
#include <string>

namespace epafi::test {

/// Numbers that every standard library draws alike.
class Dice {
public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double scaled(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  int upTo(int sides) { return static_cast<int>(engine_() % static_cast<unsigned>(sides)); }

private:
  std::mt19937 engine_;
};

/// What holds the blocks beside friction.
enum class Hold { held, slides, floats, pair, stack };

/// A scene and its friction, all drawn from a seed.
struct Draw {
  int dimension, elements, order;
  double coefficient = 0, traction = 0; ///< Coulomb's μ, Tresca's bound
  double jump = 0;                      ///< c_t is up to so much
  unsigned seed;
  scene::Scene scene;
  std::string words;
};

Draw drawn(unsigned seed, int dimension, Hold hold);

scene::Decomposition randomCut(Dice& dice, int dimension, int elements);

} // namespace epafi::test
