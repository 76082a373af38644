// A scene brought to life: meshes loaded, world built, device open; and the loop that runs it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "odds/haptics/device_track.hpp"
#include "odds/haptics/recording_device.hpp"
#include "odds/haptics/renderer.hpp"
#include "odds/haptics/tick_record.hpp"
#include "odds/realtime/periodic_loop.hpp"
#include "odds/realtime/thread_setup.hpp"
#include "odds/scene/pose_track.hpp"
#include "odds/scene/scene.hpp"

namespace odds::scene {

/// Work units that stand for one microsecond where a scene gives microseconds and the run is to be repeatable.
inline constexpr double work_units_per_us = 20.0;

/// The limit without the clock: the smaller of its work units and those that its microseconds stand for, at least 1.
[[nodiscard]] query::Budget in_work_units(const query::Budget& limit) noexcept;

struct SimulationOptions {
  /// Time passes only in the loop's sleep, budgets are work units instead of microseconds: as fast as the machine can,
  /// and the same forces bit for bit on every run.
  bool simulated_time = false;
  std::optional<double> seconds;  ///< how long to run; nothing: as the scene says
  /// In simulated time: numbers of the planned ticks that are served, ascending; the others are skipped, as they were
  /// in a run whose machine was too slow. Empty: all.
  std::vector<std::uint64_t> served;
  haptics::AllocationCount allocations = nullptr;
  realtime::Clock clock = {};    ///< of phases and effects, not queries; null: realtime::fastest_clock()
  bool contact_impulse = false;  ///< whether World::contact_impulse is wanted
  /// Given the scene's device, not yet open, says which one to use. Empty: that one.
  std::function<std::unique_ptr<haptics::Device>(std::unique_ptr<haptics::Device>)> use_device;
  /// Called while building: what is being done, and how far it is in [0, 1]. May be empty.
  std::function<void(std::string_view what, double share)> progress;
};

/// What a run left behind.
struct RunOutcome {
  realtime::LoopSummary loop;
  std::vector<haptics::TickRecord> ticks;  ///< in order
  std::uint64_t records_lost = 0;          ///< the writer did not keep up
  std::vector<realtime::SetupLine> thread;
  haptics::DeviceTrack device_track;  ///< what the device said; empty without a device
  PoseTrack poses;                    ///< of all dynamic bodies
  haptics::SafetyCounts safety;
  std::uint64_t failed_reads = 0;
  std::uint64_t rescued_steps = 0;
  std::uint64_t contacts_left_out = 0;
  std::uint64_t pairs_left_out = 0;           ///< for which a frame had no time left
  std::uint64_t solver_messages = 0;          ///< with which ODE's solver complained
  double frame_overshoot_us = 0.0;            ///< largest, of a step's frame beyond its time
  std::vector<haptics::EffectCost> effects;   ///< what each effect took, in the order in which they act
  std::vector<haptics::ContactEvent> events;  ///< if the scene asks for events
  std::uint64_t events_lost = 0;
  double least_energy_j = 0.0;  ///< lowest balance of energy at the hand; below zero: more given than taken
};

/// One mesh of the scene, for people.
struct LoadedMesh {
  std::string name;
  std::string file;
  std::uint64_t triangles = 0;
};

/// Not copyable, not movable: the renderer points into it.
class Simulation {
 public:
  /// Loads the meshes, builds the world, opens the device and takes all memory of the loop: seconds, for large meshes.
  /// An error says where in the scene, if it can, and what to do: a run that is too long or whose records would not fit
  /// into memory, a mesh that is missing or bad, a body, an effect or settings that cannot be, a device that is
  /// unknown, does not open or gives no position. The device stays open until the end. For set-up, in any thread; one
  /// thread at a time uses what is made. May throw std::bad_alloc.
  static Result<std::unique_ptr<Simulation>> make(Scene scene, const SimulationOptions& options);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Runs the loop to its end, or until `stop` is requested, in a thread of its own; returns when it has ended. Once
  /// per simulation.
  RunOutcome run(const std::stop_token& stop = {});

  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] const std::vector<LoadedMesh>& meshes() const noexcept { return meshes_; }
  /// Of the meshes, in the scene's order.
  [[nodiscard]] const std::vector<std::shared_ptr<const query::Shape>>& shapes() const noexcept { return shapes_; }
  /// Sentences about what may go wrong with this scene; e.g. the sampled-data rule.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  /// After a run: a sentence if the device went beyond its workspace; "" if it did not.
  [[nodiscard]] std::string workspace_warning() const;
  /// After a run: a sentence if ODE's solver complained; "" if it did not.
  [[nodiscard]] std::string solver_warning() const;
  /// After a run: both, and a sentence if the device gave no pose at the start or did not switch its forces on.
  [[nodiscard]] std::vector<std::string> run_warnings() const;
  /// The budget that the queries really have.
  [[nodiscard]] const query::Budget& budget() const noexcept;
  [[nodiscard]] ode::World& world() noexcept { return *world_; }
  [[nodiscard]] haptics::Renderer& renderer() noexcept { return *renderer_; }
  /// The body that follows the device, if there is one.
  [[nodiscard]] std::optional<ode::BodyId> tool() const noexcept { return tool_; }
  /// Null without one. For programs that call renderer().tick themselves; run() switches its forces on and off.
  [[nodiscard]] haptics::Device* device() noexcept { return device_.get(); }
  [[nodiscard]] haptics::EffectSet& effects() noexcept { return *effects_; }

 private:
  Simulation(Scene scene, const SimulationOptions& options);
  std::optional<Error> load();
  std::optional<Error> add_bodies();
  std::optional<Error> add_hand();
  void warn_of_effects();
  void report(std::string_view what, double share) const;
  void note_device(bool well, std::string_view what);
  [[nodiscard]] PoseTrack make_pose_track() const;
  void run_loop(const std::stop_token& stop, RunOutcome& outcome);

  Scene scene_;
  SimulationOptions options_;
  std::vector<LoadedMesh> meshes_;
  std::vector<std::shared_ptr<const query::Shape>> shapes_;
  std::vector<std::string> warnings_;
  std::string device_complaint_;  // the first
  std::unique_ptr<haptics::EffectSet> effects_;
  std::optional<ode::World> world_;
  std::vector<ode::BodyId> bodies_;
  std::optional<ode::BodyId> tool_;
  std::uint64_t ticks_ = 0;  // planned
  std::unique_ptr<haptics::RecordingDevice> device_;
  std::unique_ptr<haptics::Renderer> renderer_;
};

}  // namespace odds::scene
