// What a scene file says: meshes, bodies, a device, limits, and the effects that are wanted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "odds/haptics/effect_set.hpp"
#include "odds/haptics/safety.hpp"
#include "odds/haptics/settings.hpp"
#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"
#include "odds/ode/world.hpp"
#include "odds/query/request.hpp"
#include "odds/realtime/thread_setup.hpp"
#include "odds/volume/kind.hpp"

namespace odds::scene {

/// The first line of every scene: format = "odds.scene/1".
inline constexpr std::string_view format_name = "odds.scene/1";

struct Loop {
  std::int64_t period_ns = 1'000'000;
  double seconds = 10.0;
  realtime::ThreadRequest thread;  ///< real-time priority, locked memory, processor
  [[nodiscard]] double period_s() const noexcept { return 1e-9 * static_cast<double>(period_ns); }
};

/// [[mesh]]
struct Mesh {
  std::string name;
  std::string file;     ///< as written: a path, or "made:SHAPE:key=value,..."
  double scale = 1.0;   ///< metres per unit of the file
  std::string package;  ///< system package that holds the file; for the error message if it is not there
  haptics::Place place;
};

/// [[body]]
struct Body {
  std::string name;
  std::size_t mesh = 0;  ///< index into Scene::meshes
  math::Pose pose;       ///< at the start; a body that follows a device begins where the device is
  bool dynamic = false;
  ode::MassSpec mass;
  bool follows_device = false;
  haptics::Place place;
};

/// [device.NAME]
struct Device {
  std::string name;
  std::string type;
  haptics::Settings settings;  ///< the whole table; the device's factory reads its part
  haptics::SafetyLimits limits;
  haptics::DeviceScale scale;
  std::optional<double> physical_damping_ns_per_m;
  haptics::Place place;
};

/// An effect that the scene asks for: computed if and only if its table is there.
struct AskedEffect {
  std::string name;
  haptics::Settings settings;  ///< the whole table; the effect's factory reads it
  haptics::Place place;        ///< of the table
};

/// A scene that makes sense in itself: names resolve, numbers are in range. Files are not opened yet, except the
/// device's.
struct Scene {
  std::string file;                      ///< for messages
  std::filesystem::path base_directory;  ///< relative paths refer to it
  std::vector<std::string>
      search;  ///< further directories for meshes; "${NAME}" stands for a variable of the environment
  Loop loop;
  query::Request query;
  query::Budget frame;  ///< of all queries of a step together, or of its part in a tick; its clock is not used
  volume::Kind volume = volume::Kind::wide;
  ode::Solver solver = ode::Solver::exact;
  int solver_iterations = 20;
  std::uint32_t max_contacts = 64;  ///< of a step, all pairs together
  double substep_way_m = std::numeric_limits<double>::infinity();
  std::uint32_t most_substeps = 1;
  std::uint32_t ticks_per_step = 1;  ///< a step of the world takes so many ticks, 1 .. 64
  haptics::Place ticks_per_step_place;
  double max_speed_m_per_s = 20.0;
  double max_spin_rad_per_s = 200.0;
  std::vector<Mesh> meshes;
  std::vector<Body> bodies;
  std::optional<Device> device;
  std::vector<AskedEffect> effects;  ///< in the order in which they act

  /// The effects, made anew. Not yet connected with a world.
  [[nodiscard]] std::unique_ptr<haptics::EffectSet> make_effects() const;
  /// The first effect of this name; null if nobody asked for it.
  [[nodiscard]] const AskedEffect* find_effect(std::string_view effect_name) const;
  /// What the world is made from, and what the effects want of it.
  [[nodiscard]] ode::WorldOptions world_options(const haptics::EffectSet& asked) const;
};

/// Reads a scene. Errors name file, line and column, and the nearest valid name where one was mistyped.
Result<Scene> read_scene(const std::filesystem::path& path);
/// The same from text; `name` stands in error messages.
Result<Scene> parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& base_directory);

}  // namespace odds::scene
