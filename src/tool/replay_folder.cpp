// Writing the replay folder.
#include "tool/replay_folder.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "mesh/csv_field.hpp"
#include "mesh/output_file.hpp"
#include "odds/haptics/device_track.hpp"

namespace odds::tool {
namespace {

using nlohmann::ordered_json;

ordered_json describe(const scene::Simulation& simulation, const report::RunInfo& info) {
  const scene::Scene& scene = simulation.scene();
  ordered_json json;
  json["format"] = "odds.replay/1";
  json["units"] = "SI: metres, seconds (t_ns: nanoseconds since the first tick), newton; quaternions w x y z";
  json["scene"] = info.scene;
  json["version"] = info.version;
  json["period_ns"] = info.period_ns;
  json["simulated_time"] = info.simulated_time;
  constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
  const query::Budget& budget = simulation.budget();
  json["budget_us"] = std::isfinite(budget.microseconds) ? ordered_json(budget.microseconds) : ordered_json(nullptr);
  json["work_units"] = budget.work_units == no_limit ? ordered_json(nullptr) : ordered_json(budget.work_units);
  json["frame_us"] = std::isfinite(info.frame_us) ? ordered_json(info.frame_us) : ordered_json(nullptr);
  json["frame_work_units"] =
      info.frame_work_units == no_limit ? ordered_json(nullptr) : ordered_json(info.frame_work_units);
  if (scene.device) {
    json["device"] = {{"name", scene.device->name}, {"type", scene.device->type}, {"track", "device.csv"}};
  } else {
    json["device"] = nullptr;
  }
  for (const scene::Mesh& mesh : scene.meshes) {
    json["meshes"].push_back({{"name", mesh.name}, {"file", mesh.file}, {"scale", mesh.scale}});
  }
  for (const scene::Body& body : scene.bodies) {
    const Vec3& p = body.pose.translation;
    const Quat q(body.pose.rotation);
    json["bodies"].push_back({{"name", body.name},
                              {"mesh", scene.meshes[body.mesh].name},
                              {"moves", body.dynamic},
                              {"follows_device", body.follows_device},
                              {"position_m", {p.x(), p.y(), p.z()}},
                              {"orientation_wxyz", {q.w(), q.x(), q.y(), q.z()}}});
  }
  return json;
}

std::optional<Error> write_events(const std::filesystem::path& path, const scene::Scene& scene,
                                  const scene::RunOutcome& outcome) {
  std::string text = "t_ns,event,a,b,approach_m_per_s\n";
  for (const haptics::ContactEvent& event : outcome.events) {
    text += fmt::format("{},{},{},{},{}\n", event.t_ns, event.begins ? "begin" : "end",
                        mesh::csv_field(scene.bodies[event.a.index].name),
                        mesh::csv_field(scene.bodies[event.b.index].name), event.approach_m_per_s);
  }
  return mesh::write_file(path, text);
}

/// Takes away what an earlier scene left: it would pass for this one's.
std::optional<Error> remove_old(const std::filesystem::path& path) {
  std::error_code code;
  std::filesystem::remove(path, code);
  if (code) return Error{path.string(), "", "of an earlier run cannot be removed: " + code.message(), "remove it"};
  return std::nullopt;
}

}  // namespace

std::optional<Error> write_replay_folder(const std::filesystem::path& folder, const scene::Simulation& simulation,
                                         const report::RunInfo& info, const scene::RunOutcome& outcome,
                                         const Result<std::string>& glb) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return Error{folder.string(), "", "cannot be made: " + code.message(), "give another --out"};
  const std::filesystem::path device = folder / "device.csv";
  if (!outcome.device_track.states.empty()) {
    if (auto error = haptics::write_track(device, outcome.device_track)) return error;
  } else if (!simulation.scene().device) {  // else it may be the track of a replay that ended before its first tick
    if (auto error = remove_old(device)) return error;
  }
  if (auto error = outcome.poses.write(folder / "poses.csv")) return error;
  const bool has_events = simulation.scene().find_effect("events") != nullptr;
  const std::filesystem::path events = folder / "events.csv";
  if (auto error = has_events ? write_events(events, simulation.scene(), outcome) : remove_old(events)) return error;
  const std::string side_car =
      describe(simulation, info).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (auto error = mesh::write_file(folder / "replay.json", side_car)) return error;
  const std::filesystem::path picture = folder / "replay.glb";
  if (!glb) return Error{picture.string(), "", glb.error().what, glb.error().remedy};
  return mesh::write_file(picture, glb.value());
}

}  // namespace odds::tool
