// SDFormat: models of a file or of a world, nested ones too, with poses relative to any frame.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "scene/import/readers.hpp"
#include "scene/import/sdf_frames.hpp"

namespace odds::scene {
namespace {

constexpr int deepest_nesting = 32;
constexpr int longest_chain = 256;  // of frames attached to frames, up to a joint's end
constexpr std::array<std::string_view, 9> joint_types = {"fixed", "revolute", "revolute2", "prismatic", "continuous",
                                                         "ball",  "screw",    "universal", "gearbox"};

class SdfReader {
 public:
  explicit SdfReader(const XmlReader& xml) : xml_(xml), frames_(xml) {}

  Description read() {
    const pugi::xml_node sdf = xml_.root();
    const pugi::xml_node world = sdf.child("world");
    for (const pugi::xml_node node : (world ? world : sdf).children()) {
      const std::string_view name = node.name();
      if (name == "model") {
        read_top_model(node);
      } else if (name == "frame") {
        add_frame(node, "", {}, node.attribute("attached_to").value());
      } else if (name == "gravity") {
        description_.gravity_m_per_s2 = xml_.vector(node, node.text().get(), "gravity");
      } else if (node.type() == pugi::node_element) {
        ++description_.left_out[std::string(name)];
      }
    }
    if (world) leave_out_beside(world);
    if (description_.models.empty()) refuse_empty(sdf, "there is no model", world ? world : sdf, "add a <model>");
    std::size_t link = 0;
    for (Model& model : description_.models) {
      for (Link& each : model.links) each.in_world = frames_.in_world(link_frames_[link++], sdf);
    }
    place_framed_collisions();
    return std::move(description_);
  }

 private:
  // A collision whose pose is not told in its link's frame: which one, and the frame.
  struct FramedCollision {
    std::size_t model = 0;
    std::size_t link = 0;
    std::size_t collision = 0;
    std::string frame;
    pugi::xml_node said_by;
  };

  // What is missing may be in a file that is included, and these are not read.
  [[noreturn]] void refuse_empty(pugi::xml_node node, std::string what, pugi::xml_node inside,
                                 std::string remedy) const {
    if (inside.child("include")) {
      what += ", and what it includes is not read";
      remedy = "make one file of it: gz sdf -p FILE > whole.sdf";
    }
    xml_.fail(node, what, remedy);
  }

  // One world is read, the first; what else the file holds, other worlds and single models, is counted.
  void leave_out_beside(pugi::xml_node world) {
    for (const pugi::xml_node node : xml_.root().children()) {
      if (node != world && node.type() == pugi::node_element) ++description_.left_out[node.name()];
    }
  }

  // "__model__" of a scope, or a name in it; "" where nothing is said.
  [[nodiscard]] static std::string scoped(const std::string& scope, std::string_view name) {
    return name == "world" ? std::string() : scope + std::string(name);
  }

  [[nodiscard]] math::Pose pose_of(pugi::xml_node owner) const {
    math::Pose pose;
    const pugi::xml_node node = owner.child("pose");
    const std::string_view text = node.text().get();
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return pose;
    if (std::string_view(node.attribute("rotation_format").value()) == "quat_xyzw") {
      const std::vector<double> v = xml_.numbers(node, text, 7, "pose");
      pose.translation = {v[0], v[1], v[2]};
      pose.rotation = xml_.rotation_of_xyzw(node, v.data() + 3);
      return pose;
    }
    const std::vector<double> v = xml_.numbers(node, text, 6, "pose");
    const double unit = xml_.flag(node, node.attribute("degrees").value()) ? std::numbers::pi / 180.0 : 1.0;
    pose.translation = {v[0], v[1], v[2]};
    pose.rotation = rotation_of_rpy(unit * Vec3(v[3], v[4], v[5]));
    return pose;
  }

  void add_frame(pugi::xml_node node, const std::string& scope, const std::string& own_model, std::string_view base) {
    const std::string_view relative_to = node.child("pose").attribute("relative_to").value();
    if (!relative_to.empty()) base = relative_to;
    const std::string frame = base.empty() ? own_model : scoped(scope, base);
    frames_.add(xml_.name(node, scope), frame, pose_of(node), node);
  }

  void read_top_model(pugi::xml_node node) {
    Model model;
    model.name = xml_.name(node);
    model.is_static = is_static(node);
    index_.clear();
    read_model(node, "", "", model, 0);
    if (model.links.empty()) {
      refuse_empty(node, fmt::format("the model '{}' has no link", model.name), node, "add a <link>");
    }
    description_.models.push_back(std::move(model));
  }

  [[nodiscard]] bool is_static(pugi::xml_node model) const {
    const pugi::xml_node node = model.child("static");
    return xml_.flag(node, node.text().get());
  }

  // `scope` is the one that the model stands in, "" or "outer::".
  void read_model(pugi::xml_node node, const std::string& scope, const std::string& outer, Model& model, int depth) {
    if (depth > deepest_nesting) xml_.fail(node, "models are nested deeper than 32", "flatten them");
    if (node.attribute("placement_frame")) {
      xml_.fail(node, "a placement_frame is not understood", "give the pose of the model's own frame");
    }
    const std::size_t first_link = model.links.size();
    const std::string own = xml_.name(node, scope);
    const std::string inside = own + "::";
    const std::string frame = inside + "__model__";
    const std::string_view relative_to = node.child("pose").attribute("relative_to").value();
    frames_.add(own, frame, {}, node);  // first, so that a name taken twice is told as it was written
    frames_.add(frame, relative_to.empty() ? outer : scoped(scope, relative_to), pose_of(node), node);
    for (const pugi::xml_node part : node.children()) {
      const std::string_view name = part.name();
      if (name == "link") {
        add_frame(part, inside, frame, "");
        model.links.push_back(read_link(part, inside, model.links.size()));
        index_.emplace(model.links.back().name, model.links.size() - 1);
        link_frames_.push_back(model.links.back().name);
      } else if (name == "frame") {
        const std::string_view to = part.attribute("attached_to").value();
        add_frame(part, inside, frame, to);
        attached_.emplace(xml_.name(part, inside), to.empty() ? frame : scoped(inside, to));
      } else if (name == "joint") {
        const std::string child = xml_.child_text(part, "child");
        add_frame(part, inside, frame, child);
        attached_.emplace(xml_.name(part, inside), scoped(inside, child));
      } else if (name == "model") {
        read_model(part, inside, frame, model, depth + 1);
      } else if (part.type() == pugi::node_element && name != "pose" && name != "static") {
        ++description_.left_out[std::string(name)];
      }
    }
    attached_.emplace(own, frame);
    attached_.emplace(frame, canonical_link(node, inside, model, first_link));
    for (const pugi::xml_node part : node.children("joint")) read_joint(part, inside, model);
    if (!is_static(node)) return;
    for (std::size_t i = first_link; i < model.links.size(); ++i) model.links[i].stands = true;
  }

  // The link that a model's own frame is attached to: the one named, or its first.
  [[nodiscard]] static std::string canonical_link(pugi::xml_node node, const std::string& inside, const Model& model,
                                                  std::size_t first) {
    if (const std::string_view named = node.attribute("canonical_link").value(); !named.empty()) {
      return inside + std::string(named);
    }
    if (const pugi::xml_node own = node.child("link")) return inside + own.attribute("name").value();
    return first < model.links.size() ? model.links[first].name : std::string();
  }

  // `index` is the one that it will have in its model.
  [[nodiscard]] Link read_link(pugi::xml_node node, const std::string& scope, std::size_t index) {
    Link link;
    link.name = xml_.name(node, scope);
    link.place = xml_.place_of(node);
    link.mass_kg = 1.0;  // the format's default
    for (const pugi::xml_node part : node.children()) {
      const std::string_view name = part.name();
      if (name == "collision") {
        const math::Pose pose = pose_of(part);
        if (auto geometry = geometry_of(xml_.child(part, "geometry"))) {
          note_frame(part, scope, link, index);
          link.collisions.push_back({pose, std::move(*geometry), xml_.place_of(part), density_of(part)});
        }
        read_friction(part);
      } else if (name == "inertial") {
        read_mass(part, link);
      } else if (part.type() == pugi::node_element && name != "pose") {
        ++description_.left_out[std::string(name)];
      }
    }
    return link;
  }

  // "auto" without a mass: of the shapes, by their densities, or the link's, or the format's default.
  void read_mass(pugi::xml_node inertial, Link& link) const {
    if (const pugi::xml_node mass = inertial.child("mass")) {
      link.mass_kg = xml_.positive(mass, mass.text().get(), "mass");
    } else if (xml_.flag(inertial, inertial.attribute("auto").value())) {
      link.mass_kg.reset();
      link.density_kg_per_m3 = density_of(inertial).value_or(1000.0);
    }
  }

  [[nodiscard]] std::optional<double> density_of(pugi::xml_node owner) const {
    const pugi::xml_node node = owner.child("density");
    if (!node) return std::nullopt;
    return xml_.positive(node, node.text().get(), "density");
  }

  // Frames are known when all is read: until then a collision has the pose that is told, in whatever frame.
  void note_frame(pugi::xml_node collision, const std::string& scope, const Link& link, std::size_t index) {
    const pugi::xml_node pose = collision.child("pose");
    const std::string_view relative_to = pose.attribute("relative_to").value();
    if (relative_to.empty()) return;
    std::string frame = scoped(scope, relative_to);
    if (frame == link.name) return;
    framed_.push_back({description_.models.size(), index, link.collisions.size(), std::move(frame), pose});
  }

  void place_framed_collisions() {
    for (const FramedCollision& framed : framed_) {
      Link& link = description_.models[framed.model].links[framed.link];
      math::Pose& in_link = link.collisions[framed.collision].in_link;
      in_link = link.in_world.inverse() * frames_.in_world(framed.frame, framed.said_by) * in_link;
    }
  }

  void read_friction(pugi::xml_node collision) {
    const pugi::xml_node mu = collision.child("surface").child("friction").child("ode").child("mu");
    if (!mu) return;
    const double value = xml_.numbers(mu, mu.text().get(), 1, "mu").front();
    if (value < 0.0) xml_.fail(mu, fmt::format("a friction of {}", value), "give a coefficient of at least 0");
    description_.frictions.push_back(value);
  }

  [[nodiscard]] std::optional<Geometry> geometry_of(pugi::xml_node node) const {
    const pugi::xml_node shape = node.find_child([](pugi::xml_node n) { return n.type() == pugi::node_element; });
    const std::string_view name = shape.name();
    Geometry geometry;
    if (name == "empty") return std::nullopt;
    if (name == "mesh") {
      geometry.kind = Geometry::Kind::mesh;
      geometry.uri = xml_.child_text(shape, "uri");
      if (geometry.uri.empty()) xml_.fail(shape, "<uri> is empty", "name the mesh's file");
      if (shape.child("submesh")) xml_.fail(shape, "a part of a mesh file", "give each part a file of its own");
      if (const pugi::xml_node scale = shape.child("scale")) {
        geometry.scale = xml_.vector(scale, scale.text().get(), "scale");
        if (!(geometry.scale.array() != 0.0).all()) xml_.fail(scale, "a scale is 0", "give three numbers, none 0");
      }
    } else if (name == "box") {
      geometry.kind = Geometry::Kind::box;
      geometry.size = xml_.positive_vector(shape, xml_.child_text(shape, "size"), "size");
    } else if (name == "sphere" || name == "cylinder" || name == "capsule") {
      geometry.kind = name == "sphere"     ? Geometry::Kind::sphere
                      : name == "cylinder" ? Geometry::Kind::cylinder
                                           : Geometry::Kind::capsule;
      geometry.radius = xml_.positive(shape, xml_.child_text(shape, "radius"), "radius");
      if (name != "sphere") geometry.length = xml_.positive(shape, xml_.child_text(shape, "length"), "length");
    } else if (name == "plane") {
      geometry.kind = Geometry::Kind::plane;
      if (const pugi::xml_node normal = shape.child("normal")) {
        geometry.normal = xml_.vector(normal, normal.text().get(), "normal");
        const double length = geometry.normal.norm();
        if (!(length > 0.0)) xml_.fail(normal, "the normal has no direction", "give a vector that is not zero");
        geometry.normal /= length;
      }
    } else {
      xml_.fail(node, fmt::format("the geometry '{}' is not read", name),
                "give box, cylinder, sphere, capsule, plane or mesh");
    }
    return geometry;
  }

  [[nodiscard]] std::size_t joint_end(pugi::xml_node joint, const char* end, const std::string& scope,
                                      const Model& model) const {
    const pugi::xml_node node = xml_.child(joint, end);
    const std::string name = XmlReader::text_of(node);
    // A link, or what is attached to one: a frame, a joint, a model.
    std::string at = scoped(scope, name);
    for (int steps = 0; steps < longest_chain; ++steps) {
      if (at.empty()) return Joint::world;
      if (const auto found = index_.find(at); found != index_.end()) return found->second;
      const auto next = attached_.find(at);
      if (next == attached_.end()) break;
      at = next->second;
    }
    std::vector<std::string_view> names;
    for (const Link& link : model.links) {
      if (link.name.starts_with(scope)) names.push_back(std::string_view(link.name).substr(scope.size()));
    }
    const std::string near = XmlReader::nearest(name, names);
    xml_.fail(node, fmt::format("there is no link named '{}'", name),
              near.empty() ? "name a link of this model" : fmt::format("did you mean '{}'?", near));
  }

  void read_joint(pugi::xml_node node, const std::string& scope, Model& model) {
    Joint joint;
    joint.name = xml_.name(node, scope);
    joint.type = xml_.text(node, "type");
    if (std::find(joint_types.begin(), joint_types.end(), joint.type) == joint_types.end()) {
      xml_.fail(node, fmt::format("the joint type '{}' is not known", joint.type),
                "valid are " + haptics::list_names(joint_types));
    }
    joint.parent = joint_end(node, "parent", scope, model);
    joint.child = joint_end(node, "child", scope, model);
    if (joint.parent == joint.child) xml_.fail(node, "a joint of a link with itself", "name two links");
    model.joints.push_back(std::move(joint));
  }

  const XmlReader& xml_;
  SdfFrames frames_;
  Description description_;
  std::map<std::string, std::size_t, std::less<>> index_;  // of links, by full name
  std::map<std::string, std::string> attached_;            // of other frames, by full name: what to; "": the world
  std::vector<std::string> link_frames_;                   // in the order of all models' links
  std::vector<FramedCollision> framed_;
};

}  // namespace

Description read_sdf(const XmlReader& xml) { return SdfReader(xml).read(); }

}  // namespace odds::scene
