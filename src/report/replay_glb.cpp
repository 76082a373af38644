// From frames to nodes, meshes and samplers.
#include "odds/report/replay_glb.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/rotation_between.hpp"
#include "report/glb_builder.hpp"
#include "report/replay_front.hpp"

namespace odds::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_contacts = 16;  // marks that are shown at once
constexpr std::size_t most_cell_pairs = 8;
constexpr std::size_t most_front_boxes = 24;
constexpr std::size_t front_opened = 64;  // boxes of each hierarchy
constexpr float hidden = 1e-6F;           // a scale of zero makes some readers divide by it

struct Track {
  std::vector<float> translations;
  std::vector<float> rotations;
  std::vector<float> scales;
};

class Glb {
 public:
  Glb(const RunInfo& info, const RunReplay& replay, std::span<const haptics::TickRecord> ticks)
      : info_(info), replay_(replay), ticks_(ticks) {
    if (!replay.bodies.empty()) origin_m_ = replay.bodies.front().pose.translation;
    for (const ReplayMesh& mesh : replay.meshes) {
      for (const auto& v : mesh.vertices) size_m_ = std::max(size_m_, 2.0 * Vec3(v[0], v[1], v[2]).norm());
    }
    if (!(size_m_ > 0.0)) size_m_ = 1.0;
  }

  Result<std::string> file() {
    materials();
    meshes();
    bodies();
    if (!replay_.frames.empty()) {
      std::vector<float> times;
      for (const ReplayFrame& frame : replay_.frames) {
        times.push_back(
            static_cast<float>(static_cast<double>(frame.tick) * static_cast<double>(info_.period_ns) * 1e-9));
      }
      times_ = glb_.floats(times, 1);
      moves();
      force();
      marks(false, most_contacts, "contact");
      marks(true, most_cell_pairs, "cell pair");
      front();
    }
    const double half = std::numbers::sqrt2 / 2.0;
    const std::size_t world =
        glb_.node({{"name", "world"},
                   {"rotation", {-half, 0.0, 0.0, half}},
                   {"children", children_},
                   {"extras", {{"origin_m", {origin_m_.x(), origin_m_.y(), origin_m_.z()}}, {"scene", info_.scene}}}});
    glb_.json["scenes"] = {{{"nodes", {world}}}};
    return glb_.file();
  }

 private:
  enum Material : int { still, moving, tool, force_colour, contact_colour, cell_colour, front_colour };

  void material(double r, double g, double b) {
    glb_.json["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {r, g, b, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.7}}},
         {"doubleSided", true}});
  }
  void materials() {
    material(0.33, 0.38, 0.42);
    material(0.04, 0.34, 0.67);
    material(0.57, 0.18, 0.0);
    material(0.54, 0.05, 0.004);
    material(0.6, 0.0, 0.0);
    material(0.8, 0.45, 0.0);
    material(0.2, 0.05, 0.35);
  }

  std::size_t mesh(const std::vector<float>& vertices, const std::vector<std::uint32_t>& indices, int colour,
                   const std::string& name) {
    const Json primitive = {{"attributes", {{"POSITION", glb_.floats(vertices, 3, true)}}},
                            {"indices", glb_.indices(indices)},
                            {"material", colour}};
    glb_.json["meshes"].push_back({{"name", name}, {"primitives", Json::array({primitive})}});
    return glb_.json["meshes"].size() - 1;
  }

  // A mesh in each colour that its bodies have: glTF binds the colour to the mesh. The numbers are shared.
  void meshes() {
    for (const ReplayMesh& source : replay_.meshes) {
      std::vector<float> vertices;
      std::vector<std::uint32_t> indices;
      for (const auto& v : source.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
      for (const mesh::Triangle& t : source.triangles) indices.insert(indices.end(), t.begin(), t.end());
      if (indices.empty()) {
        shown_.push_back({});
        continue;
      }
      const std::size_t first = mesh(vertices, indices, still, "still");
      Json copy = glb_.json["meshes"][first];
      for (const int colour : {moving, tool}) {
        copy["name"] = colour == moving ? "moving" : "tool";
        copy["primitives"][0]["material"] = colour;
        glb_.json["meshes"].push_back(copy);
      }
      shown_.push_back(first);
    }
  }

  void bodies() {
    for (const ReplayBody& body : replay_.bodies) {
      const Vec3 p = body.pose.translation - origin_m_;
      const Quat q = Quat(body.pose.rotation).normalized();
      Json node = {
          {"name", body.name}, {"translation", {p.x(), p.y(), p.z()}}, {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
      if (const auto& first = shown_[body.mesh]) {
        node["mesh"] = *first + (body.follows_device ? tool : body.moves ? moving : still);
      }
      const std::size_t index = glb_.node(std::move(node));
      children_.push_back(index);
      if (body.moves) movers_.push_back(index);
      if (body.follows_device) tool_ = movers_.size() - 1;
    }
  }

  static void push(std::vector<float>& numbers, const Vec3& v) {
    for (const double x : v) numbers.push_back(static_cast<float>(x));
  }
  // Neighbouring quaternions on one side, so that readers turn the short way.
  static void push(std::vector<float>& numbers, Quat q) {
    q.normalize();
    const std::size_t n = numbers.size();
    if (n >= 4) {
      const double dot = q.x() * static_cast<double>(numbers[n - 4]) + q.y() * static_cast<double>(numbers[n - 3]) +
                         q.z() * static_cast<double>(numbers[n - 2]) + q.w() * static_cast<double>(numbers[n - 1]);
      if (dot < 0.0) q.coeffs() *= -1.0;
    }
    for (const double x : {q.x(), q.y(), q.z(), q.w()}) numbers.push_back(static_cast<float>(x));
  }

  void animate(std::size_t node, const Track& track, const char* interpolation) {
    glb_.animate(node, "translation", times_, glb_.floats(track.translations, 3), interpolation);
    glb_.animate(node, "rotation", times_, glb_.floats(track.rotations, 4), interpolation);
    if (!track.scales.empty()) glb_.animate(node, "scale", times_, glb_.floats(track.scales, 3), interpolation);
  }

  void moves() {
    for (std::size_t k = 0; k < movers_.size(); ++k) {
      Track track;
      for (const ReplayFrame& frame : replay_.frames) {
        push(track.translations, frame.poses[k].translation - origin_m_);
        push(track.rotations, Quat(frame.poses[k].rotation));
      }
      animate(movers_[k], track, "LINEAR");
    }
  }

  [[nodiscard]] Vec3 force_at(const ReplayFrame& frame) const {
    const auto tick = std::lower_bound(ticks_.begin(), ticks_.end(), frame.tick,
                                       [](const haptics::TickRecord& t, std::uint64_t n) { return t.tick < n; });
    if (tick == ticks_.end()) return Vec3::Zero();
    return {tick->force_n[0], tick->force_n[1], tick->force_n[2]};
  }

  // An arrow along z, of length 1: a thin square rod with a pyramid on it.
  std::size_t arrow(int colour, const char* name) {
    constexpr float w = 0.02F;
    constexpr float h = 0.06F;
    const std::vector<float> vertices = {-w,   -w,   0,  w,    -w,   0, w,    w,    0,  -w,   w,    0,  -w,
                                         -w,   0.8F, w,  -w,   0.8F, w, w,    0.8F, -w, w,    0.8F, -h, -h,
                                         0.8F, h,    -h, 0.8F, h,    h, 0.8F, -h,   h,  0.8F, 0,    0,  1};
    const std::vector<std::uint32_t> indices = {0,  1, 5,  0,  5,  4,  1,  2,  6, 1,  6, 5,  2, 3, 7,  2,
                                                7,  6, 3,  0,  4,  3,  4,  7,  0, 2,  1, 0,  3, 2, 8,  9,
                                                12, 9, 10, 12, 10, 11, 12, 11, 8, 12, 8, 10, 9, 8, 11, 10};
    return mesh(vertices, indices, colour, name);
  }

  void force() {
    if (!tool_) return;
    double greatest = 1e-9;
    for (const ReplayFrame& frame : replay_.frames) greatest = std::max(greatest, force_at(frame).norm());
    Track track;
    for (const ReplayFrame& frame : replay_.frames) {
      const Vec3 force = force_at(frame);
      const double length = force.norm() / greatest * size_m_;
      push(track.translations, frame.poses[*tool_].translation - origin_m_);
      push(track.rotations, math::rotation_between(Vec3::UnitZ(), length > 0.0 ? force : Vec3::UnitZ().eval()));
      push(track.scales, Vec3::Constant(std::max(length, static_cast<double>(hidden))));
    }
    add_animated("force on the hand", arrow(force_colour, "force"), track, "LINEAR");
  }

  // Marks jump from place to place: no interpolation between them.
  void marks(bool cell_pairs, std::size_t most, const char* name) {
    std::vector<Track> tracks(most);
    std::size_t used = 0;
    for (const ReplayFrame& frame : replay_.frames) {
      std::size_t n = 0;
      for (const ReplayMark& mark : frame.marks) {
        if (mark.cell_pair != cell_pairs || n == most) continue;
        Track& track = tracks[n++];
        push(track.translations, mark.position_m - origin_m_);
        push(track.rotations, math::rotation_between(Vec3::UnitZ(), mark.normal));
        push(track.scales, Vec3::Constant(0.25 * size_m_ * std::max(0.2, mark.probability)));
      }
      used = std::max(used, n);
      for (; n < most; ++n) {
        push(tracks[n].translations, Vec3::Zero());
        push(tracks[n].rotations, Quat::Identity());
        push(tracks[n].scales, Vec3::Constant(static_cast<double>(hidden)));
      }
    }
    if (used == 0) return;
    const std::size_t shape = arrow(cell_pairs ? cell_colour : contact_colour, name);
    for (std::size_t i = 0; i < used; ++i) add_animated(name, shape, tracks[i], "STEP");
  }

  // The edges of a cube of half 1.
  std::size_t frame_of_a_box() {
    std::vector<float> corners;
    for (unsigned c = 0; c < 8; ++c) {
      for (unsigned axis = 0; axis < 3; ++axis) corners.push_back((c >> axis & 1U) != 0 ? 1.0F : -1.0F);
    }
    const std::size_t made =
        mesh(corners, {0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7}, front_colour, "front");
    glb_.json["meshes"][made]["primitives"][0]["mode"] = 1;  // lines
    return made;
  }

  // Boxes come and go: those of a picture take the first places.
  void front() {
    std::vector<Track> tracks(most_front_boxes);
    std::size_t used = 0;
    for (const ReplayFrame& frame : replay_.frames) {
      const std::vector<FrontBox> boxes = front_of(replay_, frame, front_opened, most_front_boxes);
      used = std::max(used, boxes.size());
      for (std::size_t n = 0; n < most_front_boxes; ++n) {
        const bool shows = n < boxes.size();
        push(tracks[n].translations, shows ? Vec3(boxes[n].center - origin_m_) : Vec3::Zero());
        push(tracks[n].rotations, shows ? Quat(boxes[n].axes) : Quat::Identity());
        push(tracks[n].scales, shows ? boxes[n].half.cwiseMax(static_cast<double>(hidden)).eval()
                                     : Vec3::Constant(static_cast<double>(hidden)).eval());
      }
    }
    if (used == 0) return;
    const std::size_t shape = frame_of_a_box();
    for (std::size_t i = 0; i < used; ++i) add_animated("front", shape, tracks[i], "STEP");
  }

  void add_animated(const std::string& name, std::size_t shape, const Track& track, const char* interpolation) {
    const std::size_t node = glb_.node({{"name", name}, {"mesh", shape}, {"scale", {hidden, hidden, hidden}}});
    children_.push_back(node);
    animate(node, track, interpolation);
  }

  const RunInfo& info_;
  const RunReplay& replay_;
  std::span<const haptics::TickRecord> ticks_;
  Vec3 origin_m_ = Vec3::Zero();
  double size_m_ = 0.0;  // of the largest body
  GlbBuilder glb_;
  std::vector<std::optional<std::size_t>> shown_;  // the first of a mesh's three colours
  std::vector<std::size_t> children_;
  std::vector<std::size_t> movers_;
  std::optional<std::size_t> tool_;  // among the movers
  std::size_t times_ = 0;
};

}  // namespace

Result<std::string> replay_glb(const RunInfo& info, const RunReplay& replay,
                               std::span<const haptics::TickRecord> ticks) {
  return Glb(info, replay, ticks).file();
}

}  // namespace odds::report
