// A contact that is kept lies half-way between two surfaces, as those between meshes; written ones on the mesh's own.
#include "ode/collide/kept_contacts.hpp"

#include <array>

#include "ode/frame/frame_share.hpp"

namespace odds::ode {

void write_kept(std::span<const query::Contact> contacts, const math::Pose& mesh_in_world,
                ContactWriter& writer) noexcept {
  note_kept();
  for (const query::Contact& contact : contacts) {
    const Vec3 on_mesh = contact.position - 0.5 * contact.depth * contact.normal;
    writer.add(mesh_in_world * on_mesh, mesh_in_world.rotation * contact.normal, contact.depth, contact.triangle_a,
               query::no_feature);
  }
}

void settle_contacts(const math::Pose& mesh_in_world, const math::Pose& body_in_mesh, bool finished, double size,
                     const RestingContacts::Question& question, RestingContacts& resting, ContactWriter& writer,
                     const HeldContacts::StillMeets& meets) noexcept {
  std::array<query::Contact, query::most_contacts> made;
  const math::Pose into_mesh = mesh_in_world.inverse();
  const auto count = static_cast<std::size_t>(writer.count());
  for (std::size_t i = 0; i < count; ++i) {
    const dContactGeom& contact = writer[static_cast<int>(i)];
    made[i].normal = into_mesh.rotation * Vec3(contact.normal[0], contact.normal[1], contact.normal[2]);
    made[i].depth = contact.depth;
    made[i].position =
        into_mesh * Vec3(contact.pos[0], contact.pos[1], contact.pos[2]) + 0.5 * made[i].depth * made[i].normal;
    made[i].triangle_a = static_cast<std::uint32_t>(contact.side1);
    made[i].triangle_b = query::no_feature;
  }
  std::array<query::Contact, query::most_contacts> best;
  const std::size_t best_count =
      resting.settle(question, std::span(made).first(count), finished, body_in_mesh, size, meets, best);
  note_kept();
  if (finished) return;  // they are what was written
  writer.clear();
  write_kept(std::span(best).first(best_count), mesh_in_world, writer);
}

int give_kept(const math::Pose& mesh_in_world, const math::Pose& body_in_mesh, double size,
              const RestingContacts::Question& question, RestingContacts& resting, ContactWriter& writer) noexcept {
  std::array<query::Contact, query::most_contacts> kept;
  const std::size_t count = resting.held(question, body_in_mesh, size, kept);
  write_kept(std::span(kept).first(count), mesh_in_world, writer);
  current_share->report(0, writer.count(), Outcome::unknown);
  return writer.count();
}

}  // namespace odds::ode
