// Contacts with bodies of ODE from collision to collision: what is written, what is kept.
#pragma once

#include <span>

#include "odds/math/pose.hpp"
#include "odds/query/answer.hpp"
#include "ode/collide/contact_writer.hpp"
#include "ode/geom/resting_contacts.hpp"

namespace odds::ode {

/// Writes contacts that are kept, in the mesh's frame. A frame may have them given again.
void write_kept(std::span<const query::Contact> contacts, const math::Pose& mesh_in_world,
                ContactWriter& writer) noexcept;

/// Keeps what a collision has written, whose writer's g1 is the mesh; of one that is not `finished` beside what was
/// kept before, about which `meets` may be asked, and then writes that instead. `size`: of the smaller body, metres.
void settle_contacts(const math::Pose& mesh_in_world, const math::Pose& body_in_mesh, bool finished, double size,
                     const RestingContacts::Question& question, RestingContacts& resting, ContactWriter& writer,
                     const HeldContacts::StillMeets& meets = {}) noexcept;

/// Of a frame in which it is not this pair's turn: writes what is kept, where the bodies are now. Returns the number.
int give_kept(const math::Pose& mesh_in_world, const math::Pose& body_in_mesh, double size,
              const RestingContacts::Question& question, RestingContacts& resting, ContactWriter& writer) noexcept;

}  // namespace odds::ode
