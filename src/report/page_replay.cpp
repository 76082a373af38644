// The replay on the page: its place, and its numbers as JSON with binary arrays in base64.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "report/base64.hpp"
#include "report/page_parts.hpp"
#include "report/run_files.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return fmt::format("\"{}\"", base64_encode(bytes));
}

// Text inside JSON inside a script element: no quote, no backslash, no tag.
std::string json_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&' || byte >= 0x7f) {
      safe += fmt::format("\\u{:04x}", byte);  // bytes beyond ASCII as Latin-1: names are for reading only
    } else {
      safe += c;
    }
  }
  return fmt::format("\"{}\"", safe);
}

void append(std::vector<float>& numbers, const math::Pose& pose, const Vec3& origin_m) {
  const Vec3 p = pose.translation - origin_m;
  const Quat q(pose.rotation);
  for (const double x : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) numbers.push_back(static_cast<float>(x));
}

std::string meshes_json(const RunReplay& replay) {
  std::string json = "[";
  for (const ReplayMesh& mesh : replay.meshes) {
    std::vector<float> vertices;
    std::vector<std::uint32_t> indices;
    for (const auto& v : mesh.vertices) vertices.insert(vertices.end(), v.begin(), v.end());
    for (const mesh::Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    std::vector<float> boxes;
    for (const query::UpperBox& box : mesh.boxes) {
      for (const double x : box.center) boxes.push_back(static_cast<float>(x));
      for (const double x : box.half) boxes.push_back(static_cast<float>(x));
      boxes.push_back(static_cast<float>(box.first));
      boxes.push_back(static_cast<float>(box.children));
    }
    json += fmt::format("{}{{\"vertices\":{},\"indices\":{},\"boxes\":{}}}", json.size() > 1 ? "," : "",
                        packed(vertices), packed(indices), packed(boxes));
  }
  return json + "]";
}

std::string bodies_json(const RunReplay& replay, const Vec3& origin_m) {
  std::string json = "[";
  for (const ReplayBody& body : replay.bodies) {
    std::vector<float> pose;
    append(pose, body.pose, origin_m);
    json +=
        fmt::format("{}{{\"name\":{},\"mesh\":{},\"moves\":{},\"tool\":{},\"pose\":{}}}", json.size() > 1 ? "," : "",
                    json_text(body.name), body.mesh, body.moves, body.follows_device, packed(pose));
  }
  return json + "]";
}

}  // namespace

std::string replay_data(const RunInfo& info, const RunReplay& replay, std::span<const haptics::TickRecord> ticks) {
  // Floats, which graphics want, are too coarse far from the origin: everything is told from the first body's place.
  const Vec3 origin_m = replay.bodies.empty() ? Vec3::Zero().eval() : replay.bodies.front().pose.translation;
  std::vector<float> times;
  std::vector<float> poses;
  std::vector<std::uint32_t> mark_ends;  // of each frame
  std::vector<float> marks;  // position, normal, depth in millimetres, probability; of a cell pair below zero
  std::vector<float> felt;   // force, its size left to the page; device; depth in millimetres; contacts
  for (const ReplayFrame& frame : replay.frames) {
    const auto tick =
        std::lower_bound(ticks.begin(), ticks.end(), frame.tick,
                         [](const haptics::TickRecord& t, std::uint64_t number) { return t.tick < number; });
    times.push_back(static_cast<float>(static_cast<double>(frame.tick) * static_cast<double>(info.period_ns) * 1e-9));
    for (const math::Pose& pose : frame.poses) append(poses, pose, origin_m);
    for (const ReplayMark& mark : frame.marks) {
      for (const double x : (mark.position_m - origin_m).eval()) marks.push_back(static_cast<float>(x));
      for (const double x : mark.normal) marks.push_back(static_cast<float>(x));
      marks.push_back(static_cast<float>(mark.depth_m * 1e3));
      marks.push_back(static_cast<float>(mark.cell_pair ? -std::max(mark.probability, 1e-6) : mark.probability));
    }
    mark_ends.push_back(static_cast<std::uint32_t>(marks.size() / 8));
    const haptics::TickRecord record = tick == ticks.end() ? haptics::TickRecord{} : *tick;
    for (const double x : record.force_n) felt.push_back(static_cast<float>(x));
    for (int k = 0; k < 3; ++k) {
      felt.push_back(static_cast<float>(record.device_position_m[static_cast<std::size_t>(k)] - origin_m[k]));
    }
    felt.push_back(static_cast<float>(record.max_depth_m * 1e3));
    felt.push_back(static_cast<float>(record.contacts));
  }
  return fmt::format(
      "{{\"meshes\":{},\"bodies\":{},\"times\":{},\"poses\":{},\"felt\":{},\"markEnds\":{},\"marks\":{},"
      "\"hand\":{}}}",
      meshes_json(replay), bodies_json(replay, origin_m), packed(times), packed(poses), packed(felt), packed(mark_ends),
      packed(marks), info.device.empty() || info.device == "none" ? "false" : "true");
}

std::string page_replay(const RunReplay& replay) {
  std::uint64_t shown = 0;
  std::uint64_t whole = 0;
  for (const ReplayMesh& mesh : replay.meshes) {
    shown += mesh.triangles.size();
    whole += mesh.triangles_of_mesh;
  }
  return fmt::format(
      "<h2 id=\"replay\">Replay</h2>\n<p>The run again: bodies where they were, the force on the hand as an arrow at "
      "the tool, "
      "the hand as a dot; contacts as red needles along their normals, the most probable pairs of cells of queries "
      "without a proof as amber ones, the longer the likelier. <em>Front</em> shows where a search of this pose "
      "arrives in the hierarchies of the run, down to their thousand largest boxes: those that overlap another body's. "
      "Drag to turn, wheel to come nearer, space to "
      "play.{}</p>\n<figure class=\"replay\"><canvas "
      "id=\"replay-view\" "
      "tabindex=\"0\" role=\"img\" aria-label=\"the scene in three dimensions\"></canvas><div "
      "class=\"replay-bar\"><button "
      "id=\"replay-play\" type=\"button\">Play</button><input id=\"replay-time\" type=\"range\" min=\"0\" max=\"1\" "
      "value=\"0\" "
      "step=\"1\" aria-label=\"time\"><output id=\"replay-text\"></output><span "
      "class=\"replay-layers\"><label><input id=\"replay-marks\" type=\"checkbox\" "
      "checked>contacts</label><label><input "
      "id=\"replay-front\" type=\"checkbox\">front</label></span></div></figure>\n",
      shown < whole ? fmt::format(" For the eye the meshes are simplified from {} to {} triangles.", grouped(whole),
                                  grouped(shown))
                    : "");
}

}  // namespace odds::report
