// URDF: links, collision geometry, joints, masses; friction where Gazebo's or Bullet's extensions state it.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/import/readers.hpp"

namespace odds::scene {
namespace {

constexpr std::array<std::string_view, 6> joint_types = {"fixed",     "revolute", "continuous",
                                                         "prismatic", "floating", "planar"};

class UrdfReader {
 public:
  explicit UrdfReader(const XmlReader& xml) : xml_(xml) {}

  Description read() {
    const pugi::xml_node robot = xml_.root();
    model_.name = robot.attribute("name").value();
    if (model_.name.empty()) model_.name = "robot";
    xml_.check_name(robot, model_.name);
    for (const pugi::xml_node node : robot.children()) {
      const std::string_view name = node.name();
      if (name == "link") {
        read_link(node);
      } else if (name != "joint" && name != "gazebo" && node.type() == pugi::node_element) {
        ++description_.left_out[std::string(name)];
      }
    }
    if (model_.links.empty()) xml_.fail(robot, "the robot has no link", "add a <link>");
    for (const pugi::xml_node node : robot.children("joint")) read_joint(node);
    for (const pugi::xml_node node : robot.children("gazebo")) read_gazebo(node);
    place_links(robot);
    description_.models.push_back(std::move(model_));
    return std::move(description_);
  }

 private:
  [[nodiscard]] math::Pose origin_of(pugi::xml_node node) const {
    math::Pose pose;
    const pugi::xml_node origin = node.child("origin");
    if (const pugi::xml_attribute xyz = origin.attribute("xyz")) {
      pose.translation = xml_.vector(origin, xyz.value(), "xyz");
    }
    const pugi::xml_attribute rpy = origin.attribute("rpy");
    const pugi::xml_attribute quaternion = origin.attribute("quat_xyzw");
    if (rpy && quaternion) xml_.fail(origin, "both 'rpy' and 'quat_xyzw' are given", "keep one of them");
    if (rpy) pose.rotation = rotation_of_rpy(xml_.vector(origin, rpy.value(), "rpy"));
    if (quaternion) {
      pose.rotation = xml_.rotation_of_xyzw(origin, xml_.numbers(origin, quaternion.value(), 4, "quat_xyzw").data());
    }
    return pose;
  }

  void read_link(pugi::xml_node node) {
    Link link;
    link.name = xml_.name(node);
    link.place = xml_.place_of(node);
    if (!index_.emplace(link.name, model_.links.size()).second) {
      xml_.fail(node, fmt::format("a second link named '{}'", link.name), "give each link a name of its own");
    }
    for (const pugi::xml_node part : node.children()) {
      const std::string_view name = part.name();
      if (name == "collision") {
        link.collisions.push_back({origin_of(part), geometry_of(xml_.child(part, "geometry")), xml_.place_of(part)});
      } else if (name == "inertial") {
        const pugi::xml_node mass = xml_.child(part, "mass");
        const double kg = xml_.numbers(mass, xml_.text(mass, "value"), 1, "mass").front();
        if (kg < 0.0) xml_.fail(mass, fmt::format("the mass is {} kg", kg), "give a mass of at least 0");
        link.mass_kg = kg;
      } else if (name == "contact") {
        if (const pugi::xml_node mu = part.child("lateral_friction")) note_friction(mu, xml_.text(mu, "value"));
      } else if (part.type() == pugi::node_element) {
        ++description_.left_out[std::string(name)];
      }
    }
    model_.links.push_back(std::move(link));
  }

  [[nodiscard]] Geometry geometry_of(pugi::xml_node node) const {
    Geometry geometry;
    const pugi::xml_node shape = node.find_child([](pugi::xml_node n) { return n.type() == pugi::node_element; });
    const std::string_view name = shape.name();
    if (name == "mesh") {
      geometry.kind = Geometry::Kind::mesh;
      geometry.uri = xml_.text(shape, "filename");
      if (const pugi::xml_attribute scale = shape.attribute("scale")) {
        geometry.scale = xml_.vector(shape, scale.value(), "scale");
        if (!(geometry.scale.array() != 0.0).all()) {
          xml_.fail(shape, "a scale is 0", "give three numbers that are not 0");
        }
      }
    } else if (name == "box") {
      geometry.kind = Geometry::Kind::box;
      geometry.size = xml_.positive_vector(shape, xml_.text(shape, "size"), "size");
    } else if (name == "sphere" || name == "cylinder" || name == "capsule") {
      geometry.kind = name == "sphere"     ? Geometry::Kind::sphere
                      : name == "cylinder" ? Geometry::Kind::cylinder
                                           : Geometry::Kind::capsule;
      geometry.radius = xml_.positive(shape, xml_.text(shape, "radius"), "radius");
      if (name != "sphere") geometry.length = xml_.positive(shape, xml_.text(shape, "length"), "length");
    } else {
      xml_.fail(node, fmt::format("the geometry '{}' is not known", name),
                "give box, cylinder, sphere, capsule or mesh");
    }
    return geometry;
  }

  void note_friction(pugi::xml_node node, std::string_view text) {
    const double mu = xml_.numbers(node, text, 1, "friction").front();
    if (mu < 0.0) xml_.fail(node, fmt::format("a friction of {}", mu), "give a coefficient of at least 0");
    description_.frictions.push_back(mu);
  }

  void read_gazebo(pugi::xml_node node) {
    if (const pugi::xml_node mu = node.child("mu1")) {
      const char* value = mu.attribute("value").value();
      note_friction(mu, *value != '\0' ? value : mu.text().get());
    }
    const pugi::xml_node is_static = node.child("static");
    if (xml_.flag(is_static, is_static.text().get())) model_.is_static = true;
    for (const pugi::xml_node part : node.children()) {
      const std::string_view name = part.name();
      if (part.type() == pugi::node_element && name != "mu1" && name != "static") {
        ++description_.left_out[std::string(name)];
      }
    }
  }

  [[nodiscard]] std::size_t link_named(pugi::xml_node joint, const char* end) const {
    const pugi::xml_node node = xml_.child(joint, end);
    const std::string name = xml_.text(node, "link");
    if (const auto found = index_.find(name); found != index_.end()) return found->second;
    std::vector<std::string_view> names;
    for (const Link& link : model_.links) names.push_back(link.name);
    const std::string near = XmlReader::nearest(name, names);
    xml_.fail(node, fmt::format("there is no link named '{}'", name),
              near.empty() ? "add that link" : fmt::format("did you mean '{}'?", near));
  }

  void read_joint(pugi::xml_node node) {
    Joint joint;
    joint.name = xml_.name(node);
    joint.type = xml_.text(node, "type");
    if (std::find(joint_types.begin(), joint_types.end(), joint.type) == joint_types.end()) {
      xml_.fail(node, fmt::format("the joint type '{}' is not known", joint.type),
                "valid are " + haptics::list_names(joint_types));
    }
    joint.parent = link_named(node, "parent");
    joint.child = link_named(node, "child");
    if (!parent_joint_.emplace(joint.child, model_.joints.size()).second) {
      xml_.fail(node, fmt::format("the link '{}' has two parents", model_.links[joint.child].name),
                "a URDF is a tree: remove one of the joints");
    }
    children_[joint.parent].push_back(model_.joints.size());
    in_parent_.push_back(origin_of(node));
    model_.joints.push_back(std::move(joint));
  }

  // From the root outwards, without recursion: a chain may be long.
  void place_links(pugi::xml_node robot) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (!parent_joint_.contains(i)) order.push_back(i);
    }
    if (order.size() > 1) {
      xml_.fail(robot,
                fmt::format("the links '{}' and '{}' have no parent both", model_.links[order[0]].name,
                            model_.links[order[1]].name),
                "a URDF has one root: join them");
    }
    for (std::size_t at = 0; at < order.size(); ++at) {
      for (const std::size_t j : children_[order[at]]) {
        const Joint& joint = model_.joints[j];
        model_.links[joint.child].in_world = model_.links[joint.parent].in_world * in_parent_[j];
        order.push_back(joint.child);
      }
    }
    if (order.size() != model_.links.size()) {
      xml_.fail(robot, "joints lead in a circle", "a URDF is a tree: remove one of them");
    }
    Link& root = model_.links[order.front()];
    if (root.name != "world") return;
    // The customary way to say that the rest is bolted down; here and there to a table or a floor.
    root.stands = !root.collisions.empty();
    if (root.stands) return;
    for (Joint& joint : model_.joints) {
      if (joint.parent == order.front()) joint.parent = Joint::world;
    }
  }

  const XmlReader& xml_;
  Description description_;
  Model model_;
  std::map<std::string, std::size_t, std::less<>> index_;
  std::map<std::size_t, std::size_t> parent_joint_;  // of a link
  std::map<std::size_t, std::vector<std::size_t>> children_;
  std::vector<math::Pose> in_parent_;  // of the child, by joint
};

}  // namespace

Description read_urdf(const XmlReader& xml) { return UrdfReader(xml).read(); }

}  // namespace odds::scene
