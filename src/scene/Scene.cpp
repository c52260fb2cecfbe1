#include "epafi/scene/Scene.hpp"

namespace epafi::scene {

std::string toString(Edge edge) {
  switch (edge) {
  case Edge::left:
    return "left";
  case Edge::right:
    return "right";
  case Edge::bottom:
    return "bottom";
  case Edge::top:
    return "top";
  }
  return "unknown";
}

} // namespace epafi::scene
