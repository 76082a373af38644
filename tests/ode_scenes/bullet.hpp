// Bullet's GImpact as a collider of ODE's meshes. Without Bullet it refuses to be made.
#pragma once

#include <ode/ode.h>

#include <memory>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::ode_scenes {

class Bullet {
 public:
  /// Throws if this program was built without Bullet.
  Bullet();
  ~Bullet();
  Bullet(const Bullet&) = delete;
  Bullet& operator=(const Bullet&) = delete;

  [[nodiscard]] static bool available() noexcept;

  void add(dGeomID geom, const mesh::TriangleMesh& mesh);
  /// Contacts by ODE's rules; the first `most` that Bullet finds.
  int collide(dGeomID a, dGeomID b, int most, dContact* contacts);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace odds::ode_scenes
