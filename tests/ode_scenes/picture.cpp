#include "ode_scenes/picture.hpp"

#include <vector>

namespace odds::ode_scenes {

std::string picture_of(const Arena& arena, const View& view) {
  std::vector<testing::Drawn> bodies;
  for (const Arena::Item& item : arena.items()) {
    if (item.mesh) bodies.push_back({item.mesh.get(), pose_of(item.geom), dGeomGetBody(item.geom) == nullptr});
  }
  return testing::picture_of(bodies, view);
}

}  // namespace odds::ode_scenes
