// What URDF and SDFormat have in common: models of links, joined, with shapes to collide.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "odds/haptics/settings.hpp"
#include "odds/math/pose.hpp"

namespace odds::scene {

/// A shape to collide with. Metres.
struct Geometry {
  enum class Kind { mesh, box, sphere, cylinder, capsule, plane };
  Kind kind = Kind::box;
  Vec3 size = Vec3::Ones();  ///< of a box; of a plane x and y
  double radius = 0.0;
  double length = 0.0;  ///< along z; of a capsule without its caps
  std::string uri;      ///< of a mesh, as written
  Vec3 scale = Vec3::Ones();
  Vec3 normal = Vec3::UnitZ();  ///< of a plane
};

struct Collision {
  math::Pose in_link;
  Geometry geometry;
  haptics::Place place;
  std::optional<double> density_kg_per_m3 = {};  ///< where it is not the link's
};

struct Link {
  std::string name;
  math::Pose in_world;  ///< with all joints at zero
  std::optional<double> mass_kg;
  std::optional<double> density_kg_per_m3;  ///< of its shapes, which give its mass; nothing: mass_kg does
  bool stands = false;                      ///< attached to the world
  std::vector<Collision> collisions;
  haptics::Place place;
};

struct Joint {
  static constexpr std::size_t world = static_cast<std::size_t>(-1);
  std::string name;
  std::string type;
  std::size_t parent = world;  ///< index of a link
  std::size_t child = world;
  [[nodiscard]] bool is_fixed() const { return type == "fixed"; }
};

struct Model {
  std::string name;
  bool is_static = false;
  std::vector<Link> links;
  std::vector<Joint> joints;
};

struct Description {
  std::vector<Model> models;
  std::vector<double> frictions;  ///< Coulomb's coefficients that were stated
  std::optional<Vec3> gravity_m_per_s2;
  std::map<std::string, int> left_out;   ///< elements that were not read, by name
  std::vector<std::string> assumptions;  ///< sentences
};

}  // namespace odds::scene
