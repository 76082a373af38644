// Mass, centre and inertia of a mesh as a rigid body.
#pragma once

#include <ode/ode.h>

#include "odds/math/error.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {

/// Homogeneous mass of the enclosed volume if the mesh is closed (`closed`) and encloses one, else that of its bounding
/// box. A density without an enclosed volume is refused. `name` stands in the error.
Result<MassProperties> mass_properties(const mesh::TriangleMesh& mesh, bool closed, const MassSpec& spec,
                                       const std::string& name);

/// Makes them those of an ODE body whose origin is at the centre of mass.
void give_mass(dBodyID body, const MassProperties& properties) noexcept;

}  // namespace odds::ode
