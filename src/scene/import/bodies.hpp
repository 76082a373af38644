// From links to rigid bodies: who hangs together, who moves, and the triangles of each.
#pragma once

#include <string>
#include <vector>

#include "odds/scene/import.hpp"
#include "scene/import/description.hpp"
#include "scene/import/resources.hpp"
#include "scene/import/solids.hpp"

namespace odds::scene {

struct RigidBody {
  std::string name;
  math::Pose in_world;
  bool dynamic = false;
  double mass_kg = 0.0;  ///< of a dynamic body; 0: nobody said
  Soup triangles;        ///< in the body's frame
};

/// Links that fixed joints connect are one body; all links of a part that moves are, for its other joints are held at
/// zero. Links without collision geometry make none. What was assumed goes to `description`. Throws ImportFailure.
[[nodiscard]] std::vector<RigidBody> rigid_bodies(Description& description, const ImportOptions& options,
                                                  Resources& resources);

}  // namespace odds::scene
