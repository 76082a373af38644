// A fastener: holds a point of a body at a place of another, until it is pulled too hard.
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "haptics/effects/body_key.hpp"
#include "haptics/effects/list.hpp"

namespace odds::haptics::effects {
namespace {

struct Fastener {
  ode::BodyId body;
  ode::BodyId anchor;
  Vec3 point_m = Vec3::Zero();   // of the body, in its mesh frame
  Vec3 socket_m = Vec3::Zero();  // in the anchor's mesh frame
  double capture_m = 0.0;
  double stiffness_n_per_m = 0.0;
  double damping_ns_per_m = 0.0;
  double break_force_n = 0.0;
};

class Snap final : public Effect {
 public:
  explicit Snap(const Fastener& fastener) : fastener_(fastener) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_motion | need_history; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_before_step; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "pairs"; }
  [[nodiscard]] bool repeatable() const noexcept override { return true; }
  void reset() noexcept override { now_ = {}; }
  void keep() noexcept override { kept_ = now_; }
  void put_back() noexcept override { now_ = kept_; }

  std::uint32_t before_step(const TickView& tick) noexcept override {
    const Spot point = spot(*tick.world, fastener_.body, fastener_.point_m);
    const Spot socket = spot(*tick.world, fastener_.anchor, fastener_.socket_m);
    const Vec3 away = socket.position - point.position;
    const double distance = away.norm();
    if (distance > fastener_.capture_m) now_.armed = true;
    if (!now_.held && now_.armed && distance <= fastener_.capture_m) now_ = {true, false};
    if (!now_.held) return 1;
    // Linearly implicit, so that no stiffness and no damping is too much for the step; each of several on a body begins
    // from what those before it leave, or together they would be.
    const double h = tick.step_s;
    const double yields = h * (fastener_.damping_ns_per_m + h * fastener_.stiffness_n_per_m);
    const Mat3 soft = Mat3::Identity() + yields * (point.compliance + socket.compliance);
    const Vec3 approach = socket.velocity - point.velocity;
    const Vec3 asked = fastener_.stiffness_n_per_m * (away + h * approach) + fastener_.damping_ns_per_m * approach;
    const Vec3 force = soft.ldlt().solve(asked);
    if (fastener_.stiffness_n_per_m * distance > fastener_.break_force_n) {
      now_ = {false, false};
      return 1;
    }
    tick.world->apply(fastener_.body, {force, point.arm.cross(force)});
    tick.world->apply(fastener_.anchor, {-force, -socket.arm.cross(force)});
    return 1;
  }

 private:
  struct State {
    bool held = false;
    bool armed = true;  // may catch; not again after a break before it has been pulled away
  };
  struct Spot {
    Vec3 position;
    Vec3 velocity;  // after the step, as far as weight and what pulls already, other fasteners too, change it
    Vec3 arm;
    Mat3 compliance;  // 1 / kg: how fast an impulse moves the point
  };
  static Spot spot(const ode::World& world, ode::BodyId body, const Vec3& local_m) noexcept {
    const ode::BodyState state = world.state(body);
    const Vec3 position = state.pose * local_m;
    if (!world.is_dynamic(body)) return {position, Vec3::Zero(), Vec3::Zero(), Mat3::Zero()};
    const ode::MassProperties& mass = world.mass(body);
    const Vec3 arm = position - state.pose * mass.center_m;
    Mat3 lever;  // times a vector: the cross product with the arm
    lever << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(), arm.x(), 0.0;
    const Mat3& r = state.pose.rotation;
    const Mat3 turns = r * mass.inertia_kg_m2.inverse() * r.transpose();
    const double h = world.options().step_s;
    const ode::Wrench pull = world.applied(body);
    const Vec3 velocity = state.velocity_m_per_s + h * (world.options().gravity_m_per_s2 + pull.force_n / mass.mass_kg);
    const Vec3 spin = state.angular_velocity_rad_per_s + h * (turns * pull.torque_nm);
    return {position, velocity + spin.cross(arm), arm, Mat3::Identity() / mass.mass_kg - lever * turns * lever};
  }

  Fastener fastener_;
  State now_;
  State kept_;
};

}  // namespace

Result<std::unique_ptr<Effect>> make_snap(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Fastener fastener;
  read_body(reader, "body", request.bodies, true, fastener.body);
  read_body(reader, "anchor", request.bodies, false, fastener.anchor);
  reader.vector("point_m", fastener.point_m);
  reader.vector("socket_m", fastener.socket_m);
  for (const std::string_view key : {"capture_m", "stiffness_n_per_m", "break_force_n"}) reader.require(key);
  reader.number("capture_m", Range::positive(), fastener.capture_m);
  reader.number("stiffness_n_per_m", Range::positive(), fastener.stiffness_n_per_m);
  reader.number("damping_ns_per_m", Range::not_negative(), fastener.damping_ns_per_m);
  reader.number("break_force_n", Range::positive(), fastener.break_force_n);
  if (reader.has("anchor") && reader.has("body") && fastener.body == fastener.anchor) {
    reader.reject("anchor", "a body cannot be fastened to itself", "name another body");
  }
  if (fastener.stiffness_n_per_m * fastener.capture_m > fastener.break_force_n) {
    reader.reject("capture_m", "the fastener would break as soon as it has caught",
                  "give a smaller 'capture_m', or a greater 'break_force_n'");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<Snap>(fastener));
}

}  // namespace odds::haptics::effects
