// What a report says about a run besides its ticks: scene, meshes, limits, machine.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "odds/realtime/fitness.hpp"
#include "odds/realtime/host.hpp"
#include "odds/realtime/periodic_loop.hpp"
#include "odds/realtime/thread_setup.hpp"

namespace odds::report {

struct RunMesh {
  std::string name;
  std::string file;  ///< may be empty for made shapes
  std::uint64_t triangles = 0;
};

/// What one effect of the scene took.
struct RunEffect {
  std::string name;
  std::uint32_t line = 0;  ///< of the scene, where its table stands; 0: nowhere
  std::uint64_t ticks = 0;
  std::uint64_t evaluations = 0;  ///< points, bodies or rows that it worked on
  std::int64_t total_ns = 0;      ///< in its own code, without what its rows cost the solver
  std::int64_t longest_ns = 0;    ///< of one tick
};

/// Filled by whoever ran the loop. Text may come from users' files: the report escapes it.
struct RunInfo {
  std::string scene;             ///< name or file of the scene
  std::string version;           ///< of the program
  double started_epoch_s = 0.0;  ///< seconds since 1970, UTC
  std::vector<RunMesh> meshes;
  std::string bounding_volume;  ///< "obb"
  std::string device;           ///< "scripted: press"
  std::vector<std::string> effects;
  std::vector<std::string> warnings;    ///< what the program had to say about the scene, before and after the run
  std::vector<RunEffect> effect_costs;  ///< in the order in which they act; what was not asked for is not here

  std::int64_t period_ns = 1'000'000;
  double budget_us = std::numeric_limits<double>::infinity();  ///< of one query; infinity: none
  /// Of one query, of all collisions of a step together; the greatest number: none. In simulated time these stand in
  /// place of microseconds.
  std::uint64_t work_units = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t frame_work_units = std::numeric_limits<std::uint64_t>::max();
  int max_contacts = 0;                     ///< of a pair; more than one: a patch of contacts
  std::uint32_t max_contacts_per_step = 0;  ///< of all pairs together; 0: not stated
  double carry_motion = 0.0;          ///< contacts are carried along up to this part of a body's size; 0: made anew
  double allowed_overshoot_us = 1.0;  ///< net, at the 99.9th percentile
  double frame_us = std::numeric_limits<double>::infinity();  ///< of all collisions of a step together; infinity: none
  double frame_overshoot_us = 0.0;                            ///< largest, of a step's collisions beyond `frame_us`
  std::uint64_t pairs_left_out = 0;                           ///< for which a frame had no time left, over all steps
  bool simulated_time = false;  ///< wake-up and tick times are a virtual clock's; query times are real all the same
  realtime::LoopSummary loop;   ///< as run_periodic returned it

  std::vector<realtime::SetupLine> thread;
  std::vector<realtime::HostLine> host;
  std::optional<realtime::Fitness> fitness;  ///< of the machine shortly before the run
};

}  // namespace odds::report
