// A body of a world, and where it is.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <string>

#include "odds/ode/geom.hpp"
#include "odds/ode/world.hpp"
#include "ode/world/coupling_joint.hpp"
#include "ode/world/fluids.hpp"

namespace odds::ode {

struct Body {
  std::string name;
  std::shared_ptr<const query::Shape> shape;
  Geom geom;
  dBodyID body = nullptr;  // null: fixed
  MassProperties mass;
  std::unique_ptr<CouplingJoint> coupling;
  BodyState last_good;
  Vec3 contact_impulse_ns = Vec3::Zero();  // since prepare()
  PrincipalAxes principal = {};
  Fluids fluids = {};     // of the next step
  Wrench of_fluids = {};  // that they have exerted for it
};

[[nodiscard]] BodyState state_of(const Body& body) noexcept;

/// Fluids drag for one step.
void leave_fluids(Body& body) noexcept;

/// Puts it there; forces that waited for it are gone.
void place(Body& body, const BodyState& state) noexcept;

}  // namespace odds::ode
