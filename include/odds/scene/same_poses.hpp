// What limits do to contacts at the same poses: a scene that runs without a limit, and beside it the same scene with
// each.
#pragma once

#include <memory>
#include <vector>

#include "odds/haptics/tick_record.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::scene {

/// What contacts did to the tool in one tick.
struct ToolContact {
  Vec3 force_n = Vec3::Zero();  ///< mean over the tick, at the centre of mass, world frame; damping of bodies included
  std::uint32_t contacts = 0;
};

/// The leader runs without a limit, of a query or of a frame; the followers keep the scene's frame. Before each tick
/// every follower is put where the leader is, with its velocities and with what the hand says, and then takes the same
/// tick within its own limit: the two differ by the answers of that tick's queries, not by what became of earlier
/// differences. A follower's queries remember their own earlier answers, and its effects their own past, as in a run
/// with that limit.
class SamePoses {
 public:
  /// In simulated time, so that limits are work units and the run repeats. An error if no body follows a device.
  static Result<std::unique_ptr<SamePoses>> make(const Scene& scene, const std::vector<query::Budget>& limits,
                                                 const SimulationOptions& options);

  /// `record`: of the leader. As Renderer::tick.
  void tick(std::int64_t now_ns, haptics::TickRecord& record) noexcept;

  /// Of the last tick.
  [[nodiscard]] const ToolContact& exact() const noexcept { return leader_.contact; }
  [[nodiscard]] const ToolContact& limited(std::size_t i) const noexcept { return followers_[i].contact; }
  [[nodiscard]] const Simulation& leader() const noexcept { return *leader_.simulation; }

 private:
  struct HandState;
  class Listener;
  class Echo;
  struct Run {
    std::unique_ptr<Simulation> simulation;
    ToolContact contact;
    Vec3 impulse_ns = Vec3::Zero();
    void tick(std::int64_t now_ns, haptics::TickRecord& record) noexcept;
  };

  SamePoses();
  static Result<Run> make_run(Scene scene, const query::Budget& limit, SimulationOptions options);

  std::shared_ptr<HandState> hand_;
  Run leader_;
  std::vector<Run> followers_;
};

}  // namespace odds::scene
