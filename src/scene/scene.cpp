// From settings to a scene: sections, effects, and what must agree with what.
#include "odds/scene/scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "odds/haptics/device_registry.hpp"
#include "scene/effect_tables.hpp"
#include "scene/toml_settings.hpp"

namespace odds::scene {
namespace {

using haptics::Range;
using haptics::Settings;
using haptics::SettingsReader;

constexpr std::uintmax_t largest_file = std::uintmax_t{16} << 20;
constexpr std::int64_t largest_integer = std::numeric_limits<std::int64_t>::max();
constexpr std::array<std::string_view, 3> method_names = {"exact", "incremental", "time-critical"};
constexpr std::array<std::string_view, 2> estimator_names = {"cells", "kinematic"};
constexpr std::array<std::string_view, 2> solver_names = {"exact", "iterative"};
constexpr std::array<std::string_view, 2> motion_names = {"fixed", "dynamic"};

std::optional<Error> read_loop(const Settings& settings, Loop& loop) {
  SettingsReader reader(settings);
  double rate_hz = 1000.0;
  std::int64_t number = 0;
  reader.number("rate_hz", Range::between(1.0, 20000.0), rate_hz);
  reader.number("seconds", {0.0, 86400.0, true}, loop.seconds);
  if (reader.integer("realtime_priority", 1, 99, number)) loop.thread.fifo_priority = static_cast<int>(number);
  reader.flag("lock_memory", loop.thread.lock_memory);
  if (reader.integer("cpu", 0, 4095, number)) loop.thread.cpu = static_cast<int>(number);
  loop.period_ns = std::llround(1e9 / rate_hz);
  return reader.finish();
}

std::optional<Error> read_query(const Settings& settings, Scene& scene) {
  SettingsReader reader(settings);
  query::Request& request = scene.query;
  std::size_t index = 0;
  std::int64_t number = 0;
  reader.number("budget_us", Range::positive(), request.budget.microseconds);
  if (reader.integer("work_units", 1, largest_integer, number)) {
    request.budget.work_units = static_cast<std::uint64_t>(number);
  }
  if (reader.choice("method", method_names, index)) request.method = static_cast<query::Method>(index);
  if (reader.choice("estimator", estimator_names, index)) request.estimator = static_cast<query::EstimatorKind>(index);
  if (reader.choice("bv", volume::kind_words, index)) {
    scene.volume = *volume::kind_from_name(volume::kind_words[index]);
  }
  reader.number("p_min", {0.0, 1.0, true}, request.p_min);
  if (reader.integer("k_min", 1, 1'000'000, number)) request.k_min = static_cast<std::uint32_t>(number);
  if (reader.has("k_min") && !reader.has("p_min")) {
    reader.reject("k_min", "without 'p_min' no query ends on probability", "add 'p_min', or remove this key");
  }
  if (request.method == query::Method::exact && request.p_min < 1.0) {
    reader.reject("p_min", "the method 'exact' never ends on probability", "take another 'method', or remove this key");
  }
  reader.number("frame_us", Range::positive(), scene.frame.microseconds);
  if (reader.integer("frame_work_units", 1, largest_integer, number)) {
    scene.frame.work_units = static_cast<std::uint64_t>(number);
  }
  if (reader.integer("max_contacts", 0, 8, number)) request.max_contacts = static_cast<int>(number);
  reader.number("carry_motion", {0.0, 1.0}, request.carry_motion);
  return reader.finish();
}

std::optional<Error> read_physics(const Settings& settings, Scene& scene) {
  SettingsReader reader(settings);
  std::size_t index = 0;
  std::int64_t number = 0;
  if (reader.choice("solver", solver_names, index)) scene.solver = static_cast<ode::Solver>(index);
  if (reader.integer("iterations", 1, 10'000, number)) scene.solver_iterations = static_cast<int>(number);
  if (reader.has("iterations") && scene.solver != ode::Solver::iterative) {
    reader.reject("iterations", "the exact solver does not iterate",
                  "add solver = \"iterative\", or remove 'iterations'");
  }
  if (reader.integer("max_contacts", 1, 1024, number)) scene.max_contacts = static_cast<std::uint32_t>(number);
  reader.number("substep_way_m", Range::positive(), scene.substep_way_m);
  if (reader.integer("most_substeps", 2, 64, number)) scene.most_substeps = static_cast<std::uint32_t>(number);
  if (reader.has("substep_way_m") != reader.has("most_substeps")) {
    reader.reject(reader.has("substep_way_m") ? "substep_way_m" : "most_substeps",
                  "'substep_way_m' and 'most_substeps' belong together", "give both, or neither");
  }
  if (reader.integer("ticks_per_step", 2, 64, number)) scene.ticks_per_step = static_cast<std::uint32_t>(number);
  scene.ticks_per_step_place = reader.place_of("ticks_per_step");
  if (reader.has("ticks_per_step") && reader.has("most_substeps")) {
    reader.reject("ticks_per_step", "a tick is either a part of a step or several steps",
                  "remove 'ticks_per_step', or 'substep_way_m' and 'most_substeps'");
  }
  reader.number("max_speed_m_per_s", Range::positive(), scene.max_speed_m_per_s);
  reader.number("max_spin_rad_per_s", Range::positive(), scene.max_spin_rad_per_s);
  return reader.finish();
}

std::optional<Error> read_mesh(const Settings& settings, Scene& scene) {
  SettingsReader reader(settings);
  Mesh mesh;
  mesh.place = settings.place;
  reader.require("name");
  reader.require("file");
  reader.text("name", mesh.name);
  reader.text("file", mesh.file);
  reader.number("scale", Range::positive(), mesh.scale);
  reader.text("package", mesh.package);
  if (reader.has("scale") && mesh.file.starts_with("made:")) {
    reader.reject("scale", "a made shape has its size from its own parameters",
                  "remove 'scale' and give the shape another size");
  }
  if (std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const Mesh& m) { return m.name == mesh.name; })) {
    reader.reject("name", fmt::format("a second mesh named '{}'", mesh.name), "give each mesh a name of its own");
  }
  scene.meshes.push_back(std::move(mesh));
  return reader.finish();
}

// The index of a name in `names`; reports an unknown one at `key`.
std::size_t resolve(SettingsReader& reader, std::string_view key, const std::string& name,
                    const std::vector<std::string_view>& names, std::string_view what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::string near = haptics::nearest_name(name, names);
  reader.reject(key, fmt::format("there is no {} named '{}'", what, name),
                !near.empty()   ? fmt::format("did you mean '{}'?", near)
                : names.empty() ? fmt::format("add a {} of this name", what)
                                : "valid are " + haptics::list_names(names));
  return 0;
}

void read_mass(SettingsReader& reader, Body& body) {
  const bool mass = reader.number("mass_kg", Range::positive(), body.mass.mass_kg);
  const bool density = reader.number("density_kg_per_m3", Range::positive(), body.mass.density_kg_per_m3);
  if (mass && density) reader.reject("density_kg_per_m3", "mass and density are both given", "keep one of them");
  if (body.dynamic && !reader.has("mass_kg") && !reader.has("density_kg_per_m3")) {
    reader.reject(body.place, fmt::format("the dynamic body '{}' has neither mass nor density", body.name),
                  "add 'mass_kg = ...' or 'density_kg_per_m3 = ...'");
  }
  for (const std::string_view key : {"mass_kg", "density_kg_per_m3"}) {
    if (!body.dynamic && reader.has(key)) {
      reader.reject(key, "a fixed body has no use for a mass",
                    fmt::format("remove '{}', or add motion = \"dynamic\"", key));
    }
  }
}

std::optional<Error> read_body(const Settings& settings, Scene& scene, std::string& device_name) {
  SettingsReader reader(settings);
  Body body;
  body.place = settings.place;
  std::string mesh;
  std::string device;
  std::size_t motion = 0;
  reader.require("name");
  reader.require("mesh");
  reader.text("name", body.name);
  reader.text("mesh", mesh);
  reader.vector("position_m", body.pose.translation);
  Quat orientation = Quat::Identity();
  reader.quaternion_wxyz("orientation_wxyz", orientation);
  body.pose.rotation = orientation.toRotationMatrix();
  body.follows_device = reader.text("device", device);
  reader.choice("motion", motion_names, motion);
  body.dynamic = motion == 1;
  read_mass(reader, body);

  std::vector<std::string_view> names;
  for (const Mesh& known : scene.meshes) names.push_back(known.name);
  if (!mesh.empty()) body.mesh = resolve(reader, "mesh", mesh, names, "[[mesh]]");
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body& b) { return b.name == body.name; })) {
    reader.reject("name", fmt::format("a second body named '{}'", body.name), "give each body a name of its own");
  }
  if (body.follows_device) {
    if (!scene.device) {
      reader.reject("device", fmt::format("there is no [device.{}]", device), "add that table, or remove 'device'");
    } else {
      resolve(reader, "device", device, {scene.device->name}, "device");
    }
    if (!body.dynamic) {
      reader.reject("device", "a fixed body cannot follow a device",
                    "add motion = \"dynamic\" and a mass, or remove 'device'");
    }
    if (!device_name.empty()) {
      reader.reject("device", "a second body that follows a device",
                    "let one body follow it; the record holds one tool");
    }
    for (const std::string_view key : {"position_m", "orientation_wxyz"}) {
      if (reader.has(key)) {
        reader.reject(key, "a body that follows a device begins where the device is", fmt::format("remove '{}'", key));
      }
    }
    device_name = device;
  }
  scene.bodies.push_back(std::move(body));
  return reader.finish();
}

// Checks the device's own keys too, by making it once.
std::optional<Error> read_device(const haptics::Setting& setting, Scene& scene) {
  const auto* settings = std::get_if<Settings>(&setting.value.data);
  if (settings == nullptr) {
    return Error{scene.file, setting.place.text(), fmt::format("'device.{}' is not a table", setting.key),
                 fmt::format("write [device.{}]", setting.key)};
  }
  SettingsReader reader(*settings);
  Device device;
  device.name = setting.key;
  device.settings = *settings;
  device.place = settings->place;
  reader.require("type");
  const bool has_type = reader.text("type", device.type);
  double damping = 0.0;
  haptics::read_safety_limits(reader, device.limits);
  haptics::read_device_scale(reader, device.scale);
  if (reader.number("physical_damping_ns_per_m", Range::not_negative(), damping))
    device.physical_damping_ns_per_m = damping;
  std::vector<std::string_view> keys;
  for (const haptics::Setting& entry : settings->entries) keys.push_back(entry.key);
  reader.allow(keys);  // the device's factory knows which of them it has
  if (auto error = reader.finish(); error || !has_type) return error;
  const haptics::DeviceRequest request{&device.settings, scene.base_directory};
  Result<std::unique_ptr<haptics::Device>> made = haptics::make_device(device.type, request);
  if (!made) return made.error();
  const haptics::DeviceSpec& spec = made.value()->spec();
  if (!reader.has("max_force_n")) device.limits.max_force_n = spec.max_force_n;
  if (!reader.has("max_torque_nm")) device.limits.max_torque_nm = spec.max_torque_nm;
  if (!reader.has("workspace_origin_m")) device.scale.origin_m = spec.workspace_center_m;
  scene.device = std::move(device);
  return std::nullopt;
}

std::optional<Error> read_devices(SettingsReader& top, Scene& scene) {
  const Settings* devices = top.table("device");
  if (devices == nullptr) return std::nullopt;
  if (devices->entries.size() > 1) {
    return Error{scene.file, devices->entries[1].place.text(), "a second device", "keep one; a loop serves one device"};
  }
  for (const haptics::Setting& setting : devices->entries) {
    if (auto error = read_device(setting, scene)) return error;
  }
  return std::nullopt;
}

// A step in parts, one in each tick.
void check_parts(SettingsReader& top, const Scene& scene) {
  if (scene.ticks_per_step == 1) return;
  if (scene.device) {
    top.reject(scene.ticks_per_step_place, "a hand feels every tick, so a step cannot take several",
               "remove 'ticks_per_step', or the device");
  }
  if (!scene.frame.is_limited()) {
    top.reject(scene.ticks_per_step_place, "nothing says how much of a step's collisions a tick takes",
               "give 'frame_us' or 'frame_work_units' in [query], or remove 'ticks_per_step'");
  }
}

// What the sections must agree on with each other.
void check_whole(SettingsReader& top, const Scene& scene, bool device_used) {
  if (scene.bodies.empty()) top.reject(top.settings().place, "the scene has no body", "add a [[body]] table");
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const bool used = std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body& b) { return b.mesh == i; });
    if (!used) {
      top.reject(scene.meshes[i].place, fmt::format("no body uses the mesh '{}'", scene.meshes[i].name),
                 "remove it, or name it in a [[body]]");
    }
  }
  if (scene.device && !device_used) {
    top.reject(scene.device->place, fmt::format("no body follows the device '{}'", scene.device->name),
               fmt::format("add device = \"{}\" to a [[body]], or remove the device", scene.device->name));
  }
  if (device_used && scene.find_effect("virtual_coupling") == nullptr) {
    top.reject(scene.device->place, "nothing connects the device with its body", "add [effects.virtual_coupling]");
  }
  check_parts(top, scene);
}

std::optional<Error> read_sections(const Settings& document, Scene& scene) {
  SettingsReader top(document);
  std::string format;
  top.require("format");
  if (top.text("format", format) && format != format_name) {
    top.reject("format", fmt::format("the format '{}' is not known", format),
               fmt::format("give format = \"{}\"", format_name));
  }
  top.texts("search", scene.search);
  if (const Settings* loop = top.table("loop")) {
    if (auto error = read_loop(*loop, scene.loop)) return error;
  }
  if (const Settings* query = top.table("query")) {
    if (auto error = read_query(*query, scene)) return error;
  }
  if (const Settings* physics = top.table("physics")) {
    if (auto error = read_physics(*physics, scene)) return error;
  }
  for (const Settings* mesh : top.tables("mesh")) {
    if (auto error = read_mesh(*mesh, scene)) return error;
  }
  if (auto error = read_devices(top, scene)) return error;
  std::string device_name;
  for (const Settings* body : top.tables("body")) {
    if (auto error = read_body(*body, scene, device_name)) return error;
  }
  if (const Settings* effects = top.table("effects")) {
    if (auto error = read_effects(*effects, scene)) return error;
  }
  if (auto error = top.finish()) return error;
  check_whole(top, scene, !device_name.empty());
  return top.finish();
}

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& base_directory) {
  Result<Settings> document = parse_toml(text, name);
  if (!document) return document.error();
  Scene scene;
  scene.file = name;
  scene.base_directory = base_directory;
  scene.query = ode::WorldOptions::with_contacts(8);
  if (auto error = read_sections(document.value(), scene)) return *error;
  return scene;
}

Result<Scene> read_scene(const std::filesystem::path& path) {
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) return Error{path.string(), "", "cannot be read: " + code.message(), "check the path of the scene"};
  if (size > largest_file) return Error{path.string(), "", "is larger than 16 MiB", "this is no scene; check the path"};
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) return Error{path.string(), "", "cannot be read", "check that it is a file and may be read"};
  const std::string whole = text.str();
  if (const std::size_t begin = whole.find_first_not_of(" \t\r\n"); begin != std::string::npos && whole[begin] == '<') {
    return Error{path.string(), "1:1", "is XML, not a scene",
                 "make a scene from a URDF or SDFormat file: odds import FILE --out DIR"};
  }
  return parse_scene(whole, path.string(), path.parent_path());
}

ode::WorldOptions Scene::world_options(const haptics::EffectSet& asked) const {
  ode::WorldOptions options;
  options.step_s = loop.period_s() * ticks_per_step;
  options.parts = ticks_per_step;
  options.query = query;
  options.frame_us = frame.microseconds;
  options.frame_work_units = frame.work_units;
  options.solver = solver;
  options.iterations = solver_iterations;
  options.max_contacts_per_step = max_contacts;
  options.max_speed_m_per_s = max_speed_m_per_s;
  options.max_spin_rad_per_s = max_spin_rad_per_s;
  asked.configure(options);
  return options;
}

}  // namespace odds::scene
