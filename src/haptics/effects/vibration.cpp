// A short decaying vibration of the hand when its tool strikes something: what makes hard things feel hard.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "haptics/effects/body_key.hpp"
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Ring {
  double force_ns_per_m = 0.0;  // amplitude per speed of approach
  double frequency_hz = 0.0;
  double decay_s = 0.0;
  double max_force_n = 0.0;
};

// After Okamura, Cutkosky and Dennerlein (IEEE/ASME Trans. Mechatronics 6, 2001).
class Vibration final : public Effect {
 public:
  explicit Vibration(const Ring& ring) : ring_(ring) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override {
    return need_one_contact | need_velocity | need_history | need_device;
  }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting | stage_after_step | stage_hand; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "ringing ticks"; }
  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    now_.touched.resize(world.body_count());
    now_.touches.resize(world.body_count());
    kept_ = now_;
    return std::nullopt;
  }
  void reset() noexcept override {
    now_.ring = {};
    std::fill(now_.touched.begin(), now_.touched.end(), false);
    std::fill(now_.touches.begin(), now_.touches.end(), false);
  }
  void keep() noexcept override { kept_ = now_; }
  void put_back() noexcept override { now_ = kept_; }
  std::uint32_t meet(const TickView& tick, ode::Meeting& meeting) noexcept override {
    if (tick.device == nullptr || !involves(meeting, tick.tool)) return 0;
    const bool touches = !meeting.contacts.empty();
    // A tool that slides along a floor strikes the wall at its end.
    const std::uint32_t other = meeting.a == tick.tool ? meeting.b.index : meeting.a.index;
    // What is known to meet, but for whose contact a budget was too short, is not struck by the next one.
    now_.touches[other] = touches || (now_.touched[other] && meeting.verdict == query::Verdict::hit);
    if (!touches || now_.touched[other]) return 0;
    Ringing& ring = now_.ring;
    const ode::ContactPoint& point = meeting.contacts.front();
    const double approach = std::max(0.0, -point.velocity_m_per_s.dot(point.normal));
    const double force = std::min(ring_.max_force_n, ring_.force_ns_per_m * approach);
    if (force < ring.amplitude_n * std::exp(-ring.since_s / ring_.decay_s))
      return 0;  // the last one still rings louder
    ring.amplitude_n = force;
    ring.since_s = 0.0;
    ring.direction = meeting.a == tick.tool ? point.normal : Vec3(-point.normal);
    return 0;
  }
  std::uint32_t after_step(const TickView& tick) noexcept override {
    if (tick.step->pairs_left_out > 0) {  // of a pair for which the frame had no time nothing new is known
      for (std::uint32_t i = 0; i < now_.touched.size(); ++i) {
        if (now_.touched[i] && tick.world->had_no_turn(tick.tool, {i})) now_.touches[i] = true;
      }
    }
    now_.touched.swap(now_.touches);
    std::fill(now_.touches.begin(), now_.touches.end(), false);
    now_.ring.since_s += tick.step_s;
    return 0;
  }
  std::uint32_t on_hand(const TickView&, ode::Wrench& on_hand) noexcept override {
    const Ringing& ring = now_.ring;
    const double left = ring.amplitude_n * std::exp(-ring.since_s / ring_.decay_s);
    if (!(left > 1e-4 * ring_.max_force_n)) return 0;
    on_hand.force_n += left * std::sin(2.0 * std::numbers::pi * ring_.frequency_hz * ring.since_s) * ring.direction;
    return 1;
  }

 private:
  struct Ringing {
    double amplitude_n = 0.0;
    double since_s = 0.0;
    Vec3 direction = Vec3::Zero();  // unit, world: away from what was struck
  };
  struct State {
    Ringing ring;
    std::vector<bool> touched;  // by body: in the last step
    std::vector<bool> touches;
  };
  Ring ring_;
  State now_;
  State kept_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_vibration(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Ring ring{10.0, 150.0, 0.02, 1.0};
  reader.number("force_ns_per_m", Range::positive(), ring.force_ns_per_m);
  reader.number("frequency_hz", Range::positive(), ring.frequency_hz);
  reader.number("decay_s", Range::positive(), ring.decay_s);
  reader.number("max_force_n", Range::positive(), ring.max_force_n);
  if (ring.frequency_hz * request.step_s > 0.4) {
    reader.reject("frequency_hz", "a loop of this rate cannot make so fast a vibration",
                  "give at most 0.4 of the loop's rate_hz");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Vibration>(ring));
}

}  // namespace odds::haptics::effects
