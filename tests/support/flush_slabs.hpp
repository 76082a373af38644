// Slabs that lie on each other, and the flat faces that are known of them.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "query/flush/flush_contacts.hpp"
#include "query/wide/searches.hpp"
#include "support/slabs.hpp"

namespace odds::testing {

inline constexpr double flush_size = 1.4;      ///< of a slab, metres
inline const Vec3 under_slab(0.4, 0.3, -0.1);  ///< where A's bottom is

/// With the faces that it looks at.
struct Flush : query::FlushContacts {
  explicit Flush(std::shared_ptr<const std::vector<mesh::FlatFace>> a,
                 std::shared_ptr<const std::vector<mesh::FlatFace>> b,
                 const query::patch::Kernels& kernels = query::wide::searches_for(query::InstructionSet::best)->patch)
      : query::FlushContacts(*a, *b, kernels), of_a(std::move(a)), of_b(std::move(b)) {}
  std::shared_ptr<const std::vector<mesh::FlatFace>> of_a, of_b;

  void move_to(const math::Pose& pose, double of_size = flush_size, bool measured = false) {
    query::FlushContacts::move_to(pose, of_size, measured, [] { return true; });
  }
  /// Faces that look up and down, as of a body that stands on another one.
  [[nodiscard]] bool explains_at(const Vec3& place, const Vec3& up = Vec3::UnitZ()) {
    return explains_crossing(place, -up, up);
  }
  [[nodiscard]] std::vector<query::Contact> contacts(std::size_t room = 8) {
    std::vector<query::Contact> all(room);
    all.resize(write(all, [] { return true; }));
    return all;
  }
};

inline Flush contacts_of(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b) {
  return Flush(std::make_shared<const std::vector<mesh::FlatFace>>(mesh::find_flat_faces(a)),
               std::make_shared<const std::vector<mesh::FlatFace>>(mesh::find_flat_faces(b)));
}

/// As of runs at one pose, until all of the depth is given.
inline std::vector<query::Contact> written(Flush& flush, const math::Pose& pose, const Vec3& seen) {
  flush.move_to(pose);
  flush.note(flush.explains_at(seen, pose.rotation.col(2).z() > 0.0 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ())), false);
  std::vector<query::Contact> contacts;
  for (int run = 0; run < 2000; ++run) {
    flush.begin();
    flush.move_to(pose);
    contacts = flush.serves() ? flush.contacts() : std::vector<query::Contact>();
  }
  return contacts;
}

}  // namespace odds::testing
