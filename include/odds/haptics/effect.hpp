// What an effect is: one thing that a scene can ask for, what it needs to know, and when in a tick it acts.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "odds/haptics/device.hpp"
#include "odds/haptics/passivity.hpp"
#include "odds/haptics/settings.hpp"
#include "odds/math/error.hpp"
#include "odds/ode/world.hpp"

namespace odds::haptics {

class EffectSet;

/// Bits of Effect::needs(). The union over a scene's effects decides what a tick computes at all: without the first
/// three nothing is collided.
enum Need : std::uint32_t {
  need_verdict = 1U << 0,       ///< whether two bodies meet; the query makes no contacts for it
  need_one_contact = 1U << 1,   ///< one place, normal and depth of a pair
  need_patch = 1U << 2,         ///< as many contacts as the scene allows
  need_velocity = 1U << 3,      ///< velocities at the contacts: slip and approach
  need_angular_rows = 1U << 4,  ///< room in the solver for torques at contacts
  need_history = 1U << 5,       ///< something kept from tick to tick
  need_motion = 1U << 6,        ///< a body that moves
  need_device = 1U << 7,        ///< the device's state
  need_contact_work = 1U << 8,  ///< what contacts did to the bodies' energy
};

/// Bits of Effect::stages(): only these functions are called.
enum Stage : std::uint32_t {
  stage_before_step = 1U << 0,
  stage_meeting = 1U << 1,
  stage_after_step = 1U << 2,
  stage_hand = 1U << 3,
};

/// A body as effects know it before the world is built.
struct BodyInfo {
  std::string name;
  bool dynamic = false;
};

/// What an effect is made from.
struct EffectRequest {
  const Settings* settings = nullptr;  ///< its table; the factory refuses keys that it does not know
  std::span<const BodyInfo> bodies;    ///< in the order of their ids
  double step_s = 0.001;
};

/// What an effect sees of the tick under way.
struct TickView {
  ode::World* world = nullptr;
  std::int64_t now_ns = 0;
  double step_s = 0.0;
  double passed_s = 0.0;  ///< since the last tick that was served: the period, or more where ticks were missed
  double moved_s = 0.0;   ///< in which the hand went energy->step_m(): since a read last told anything new
  const DeviceState* device = nullptr;  ///< in the scene, its workspace scale applied; null without one
  double force_scale = 1.0;             ///< the device's force is this multiple of the scene's
  double max_force_n = std::numeric_limits<double>::infinity();  ///< more the device is not told; 0: it exerts none
  double max_torque_nm = std::numeric_limits<double>::infinity();
  ode::BodyId tool;                           ///< the body that follows the device; means nothing without one
  const ode::StepSummary* step = nullptr;     ///< null before the step
  const PassivityObserver* energy = nullptr;  ///< at the device, up to the last tick; null without a device
};

/// A contact that began or ended.
struct ContactEvent {
  std::int64_t t_ns = 0;
  ode::BodyId a;
  ode::BodyId b;
  bool begins = false;
  double approach_m_per_s =
      0.0;  ///< at the first contact of a pair that begins, >= 0; 0 where nobody computes velocities
};

/// One effect of one scene. Made before the world; the functions of the stages run inside the tick: no allocation,
/// lock, exception, system call. Each returns how many things it worked on (points, bodies, rows): its evaluations.
class Effect {
 public:
  Effect() = default;
  Effect(const Effect&) = delete;
  Effect& operator=(const Effect&) = delete;
  virtual ~Effect() = default;

  /// Need bits.
  [[nodiscard]] virtual std::uint32_t needs() const noexcept = 0;
  /// Stage bits.
  [[nodiscard]] virtual std::uint32_t stages() const noexcept = 0;
  /// What its evaluations are: "contacts", "bodies", "ticks".
  [[nodiscard]] virtual std::string_view evaluates() const noexcept = 0;
  /// Another effect without which this one can do nothing; "" if there is none.
  [[nodiscard]] virtual std::string_view rests_on() const noexcept { return {}; }
  /// Whether a scene may ask for it several times, as [[effects.NAME]].
  [[nodiscard]] virtual bool repeatable() const noexcept { return false; }

  /// Sets what it wants of the world, before that is made.
  virtual void configure(ode::WorldOptions& /*options*/) const {}
  /// Refuses a world that the effects of the scene together ask for, e.g. a law of contact that it cannot act in. The
  /// place is that of a key, or empty for that of its table. Asked when a scene is read, and again before bind().
  [[nodiscard]] virtual std::optional<Error> check(const ode::WorldOptions& /*options*/) const { return std::nullopt; }
  /// Once the world is prepared. May allocate, and refuse the bodies that it finds.
  [[nodiscard]] virtual std::optional<Error> bind(const ode::World& /*world*/) { return std::nullopt; }
  /// At the start of a run: forgets what it kept from ticks.
  virtual void reset() noexcept {}
  /// For trials: remember the state, and go back to it.
  virtual void keep() noexcept {}
  virtual void put_back() noexcept {}

  virtual std::uint32_t before_step(const TickView& /*tick*/) noexcept { return 0; }
  virtual std::uint32_t meet(const TickView& /*tick*/, ode::Meeting& /*meeting*/) noexcept { return 0; }
  virtual std::uint32_t after_step(const TickView& /*tick*/) noexcept { return 0; }
  /// Adds to force and torque on the hand, in the scene, at the handle's origin, before the safety stages.
  virtual std::uint32_t on_hand(const TickView& /*tick*/, ode::Wrench& /*on_hand*/) noexcept { return 0; }

  /// What happened so far, for effects that write it down.
  [[nodiscard]] virtual std::span<const ContactEvent> events() const noexcept { return {}; }
  /// Events that found no room.
  [[nodiscard]] virtual std::uint64_t events_lost() const noexcept { return 0; }
  /// Stiffness of the contacts of two bodies together, N/m, where it is `before` without this effect.
  [[nodiscard]] virtual double pair_stiffness_n_per_m(ode::BodyId /*a*/, ode::BodyId /*b*/,
                                                      double before) const noexcept {
    return before;
  }
  /// Sentences on what may go wrong with it in this scene, whose effects are `all`. After bind().
  [[nodiscard]] virtual std::vector<std::string> warnings(const EffectSet& /*all*/) const { return {}; }
  /// Sentences on what may go wrong with it on this device, which stands to the scene as `scale` says.
  [[nodiscard]] virtual std::vector<std::string> device_warnings(const DeviceSpec& /*device*/,
                                                                 const DeviceScale& /*scale*/,
                                                                 double /*period_s*/) const {
    return {};
  }
};

/// "one contact, velocity": the bits in words.
[[nodiscard]] std::string needs_text(std::uint32_t needs);

}  // namespace odds::haptics
