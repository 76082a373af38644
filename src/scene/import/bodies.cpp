// Grouping links, and putting their shapes together.
#include "scene/import/bodies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "odds/mesh/enclosed_volume.hpp"

namespace odds::scene {
namespace {

constexpr std::size_t most_triangles = 20'000'000;

/// Links that hang together. `world` is the last member.
class Groups {
 public:
  explicit Groups(std::size_t links) : parent_(links + 1) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  void join(std::size_t a, std::size_t b) { parent_[root(member(a))] = root(member(b)); }
  [[nodiscard]] bool together(std::size_t a, std::size_t b) { return root(member(a)) == root(member(b)); }
  [[nodiscard]] std::size_t of(std::size_t link) { return root(link); }

 private:
  [[nodiscard]] std::size_t member(std::size_t link) const { return link == Joint::world ? parent_.size() - 1 : link; }
  [[nodiscard]] std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::vector<std::size_t> parent_;
};

class Assembly {
 public:
  Assembly(Description& description, const ImportOptions& options, Resources& resources)
      : description_(description), options_(options), resources_(resources) {}

  std::vector<RigidBody> run() {
    for (const Model& model : description_.models) add(model);
    if (held_ > 0) {
      assume(fmt::format("{} joints that move ({} and the like) are held at zero: there are no joints between bodies",
                         held_, held_name_));
    }
    if (bare_ > 0) assume(fmt::format("{} links without collision geometry make no body", bare_));
    if (planes_ > 0) {
      assume(fmt::format("{} planes are slabs of {} m by {} m", planes_, 2 * plane_half_side_m, 2 * plane_half_side_m));
    }
    if (resources_.turned() > 0) {
      assume(fmt::format("{} mesh files have triangles that face the wrong way, and are turned", resources_.turned()));
    }
    if (open_ > 0) {
      assume(
          fmt::format("{} meshes whose densities give masses are not closed: what they enclose, and so the mass, is a "
                      "guess",
                      open_));
    }
    if (merged_ > 0) {
      assume(fmt::format("the inertia of {} dynamic bodies follows from their collision meshes, not from <inertial>",
                         merged_));
    }
    return std::move(bodies_);
  }

 private:
  void assume(std::string sentence) { description_.assumptions.push_back(std::move(sentence)); }

  void add(const Model& model) {
    Groups rigid(model.links.size());
    Groups connected(model.links.size());
    for (const Joint& joint : model.joints) {
      if (joint.type == "floating") continue;  // it only says where its child begins
      connected.join(joint.parent, joint.child);
      if (joint.is_fixed()) {
        rigid.join(joint.parent, joint.child);
      } else {
        ++held_;
        if (held_name_.empty()) held_name_ = fmt::format("'{}', {}", joint.name, joint.type);
      }
    }
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      if (model.links[i].stands) connected.join(Joint::world, i);
    }
    std::map<std::size_t, std::vector<std::size_t>> groups;  // in the order of their first links
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const bool moves = dynamic(model, connected, i);
      const std::size_t key = (moves ? connected.of(i) : rigid.of(i)) * 2 + (moves ? 1 : 0);
      if (groups[key].empty()) order.push_back(key);
      groups[key].push_back(i);
    }
    for (const std::size_t key : order) add_body(model, groups[key], key % 2 == 1);
  }

  [[nodiscard]] bool dynamic(const Model& model, Groups& connected, std::size_t link) const {
    if (options_.motion != ImportMotion::as_described) return options_.motion == ImportMotion::dynamic;
    return !model.is_static && !connected.together(link, Joint::world);
  }

  void add_body(const Model& model, const std::vector<std::size_t>& links, bool moves) {
    RigidBody body;
    body.in_world = model.links[links.front()].in_world;
    body.dynamic = moves;
    const std::string& first = model.links[links.front()].name;
    body.name = first.starts_with(model.name + "::") ? first : model.name + "::" + first;
    const math::Pose world_in_body = body.in_world.inverse();
    for (const std::size_t i : links) {
      const Link& link = model.links[i];
      body.mass_kg += link.mass_kg.value_or(0.0);
      if (link.collisions.empty()) ++bare_;
      for (const Collision& collision : link.collisions) {
        const double volume_m3 =
            add_shape(collision, world_in_body * link.in_world * collision.in_link, body.triangles);
        if (!link.density_kg_per_m3) continue;
        if (moves && is_open(collision)) ++open_;
        body.mass_kg += volume_m3 * collision.density_kg_per_m3.value_or(*link.density_kg_per_m3);
      }
    }
    if (body.triangles.triangles.empty()) return;
    if (moves) {
      ++merged_;
      if (!(body.mass_kg > 0.0)) {
        assume(fmt::format("'{}' has no mass: its density is 1000 kg/m^3", body.name));
        body.mass_kg = 0.0;
      }
    }
    bodies_.push_back(std::move(body));
  }

  [[nodiscard]] bool is_open(const Collision& collision) const {
    const Geometry& geometry = collision.geometry;
    return geometry.kind == Geometry::Kind::mesh &&
           !mesh::enclosed_volume(*resources_.mesh(geometry.uri, collision.place));
  }

  /// Adds to `soup`; returns the volume of what was added.
  double add_shape(const Collision& collision, const math::Pose& in_body, Soup& soup) {
    const std::size_t before = soup.triangles.size();
    const Geometry& geometry = collision.geometry;
    if (geometry.kind == Geometry::Kind::plane) ++planes_;
    if (geometry.kind == Geometry::Kind::mesh) {
      const auto mesh = resources_.mesh(geometry.uri, collision.place);
      count(mesh->triangles().size(), collision);
      soup.add({mesh->vertices().begin(), mesh->vertices().end()}, {mesh->triangles().begin(), mesh->triangles().end()},
               in_body, geometry.scale);
    } else {
      const Soup solid = solid_of(geometry);
      count(solid.triangles.size(), collision);
      soup.add(solid.vertices, solid.triangles, in_body, Vec3::Ones());
    }
    return soup.volume(before, in_body.translation);
  }

  void count(std::size_t more, const Collision& collision) {
    triangles_ += more;
    if (triangles_ > most_triangles) {
      throw ImportFailure{{resources_.description().string(), collision.place.text(),
                           "the collision geometry has more than 20 million triangles", "use coarser meshes"}};
    }
  }

  Description& description_;
  const ImportOptions& options_;
  Resources& resources_;
  std::vector<RigidBody> bodies_;
  std::size_t triangles_ = 0;
  std::size_t held_ = 0;
  std::string held_name_;
  std::size_t bare_ = 0;
  std::size_t planes_ = 0;
  std::size_t open_ = 0;
  std::size_t merged_ = 0;
};

}  // namespace

std::vector<RigidBody> rigid_bodies(Description& description, const ImportOptions& options, Resources& resources) {
  return Assembly(description, options, resources).run();
}

}  // namespace odds::scene
