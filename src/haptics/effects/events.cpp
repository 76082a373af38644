// When which bodies began and ceased to touch. Needs a verdict only: no contacts are made for it.
#include <algorithm>
#include <vector>

#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

class Events final : public Effect {
 public:
  explicit Events(std::size_t capacity) : capacity_(capacity) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_verdict | need_history; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting | stage_after_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "meetings"; }
  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    const std::size_t n = world.body_count();
    now_.touching.clear();
    now_.touching.reserve(n * n / 2 + 1);
    kept_.touching.reserve(n * n / 2 + 1);
    log_.resize(capacity_);
    return std::nullopt;
  }
  void reset() noexcept override {
    now_.touching.clear();
    now_.used = 0;
    now_.lost = 0;
  }
  void keep() noexcept override { kept_ = now_; }
  void put_back() noexcept override { now_ = kept_; }

  std::uint32_t meet(const TickView& tick, ode::Meeting& meeting) noexcept override {
    if (meeting.verdict != query::Verdict::hit) return 1;
    // ODE gives the bodies of a pair in either order.
    const auto known = std::find_if(now_.touching.begin(), now_.touching.end(), [&](const Touch& t) {
      return (t.a == meeting.a && t.b == meeting.b) || (t.a == meeting.b && t.b == meeting.a);
    });
    if (known != now_.touching.end()) {
      known->seen = true;
      return 1;
    }
    if (now_.touching.size() == now_.touching.capacity()) return 1;  // cannot be: there is room for all pairs
    now_.touching.push_back({meeting.a, meeting.b, true});
    double approach = 0.0;
    for (const ode::ContactPoint& point : meeting.contacts) {
      approach = std::max(approach, -point.velocity_m_per_s.dot(point.normal));
    }
    note({tick.now_ns, meeting.a, meeting.b, true, approach});
    return 1;
  }
  std::uint32_t after_step(const TickView& tick) noexcept override {
    std::size_t kept = 0;
    // Of a pair for which the frame had no time nothing new is known.
    const bool some_wait = tick.step->pairs_left_out > 0;
    for (const Touch& touch : now_.touching) {
      if (touch.seen || (some_wait && tick.world->had_no_turn(touch.a, touch.b))) {
        now_.touching[kept++] = {touch.a, touch.b, false};
      } else {
        note({tick.now_ns, touch.a, touch.b, false, 0.0});
      }
    }
    now_.touching.resize(kept);
    return 0;
  }
  [[nodiscard]] std::span<const ContactEvent> events() const noexcept override { return {log_.data(), now_.used}; }
  [[nodiscard]] std::uint64_t events_lost() const noexcept override { return now_.lost; }

 private:
  struct Touch {
    ode::BodyId a;
    ode::BodyId b;
    bool seen = false;  // in this tick
  };
  struct State {
    std::vector<Touch> touching;
    std::size_t used = 0;
    std::uint64_t lost = 0;
  };
  void note(const ContactEvent& event) noexcept {
    if (now_.used == log_.size()) {
      ++now_.lost;
    } else {
      log_[now_.used++] = event;
    }
  }
  std::size_t capacity_;
  std::vector<ContactEvent> log_;
  State now_;
  State kept_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_events(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  std::int64_t capacity = 100'000;
  reader.integer("most", 1, 10'000'000, capacity);
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Events>(static_cast<std::size_t>(capacity)));
}

}  // namespace odds::haptics::effects
