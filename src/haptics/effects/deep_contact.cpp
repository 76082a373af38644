// Where solids lie deep in each other: crossing triangles no longer say which way is out, the spheres within them do.
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "haptics/effects/list.hpp"
#include "odds/query/inner_spheres.hpp"

namespace odds::haptics::effects {
namespace {

struct Parameters {
  std::int64_t spheres = 128;
  double from = 0.25;  // depth, of the thinner solid's thickness (InnerSpheres::thickness), where it begins ...
  double full = 0.5;   // ... and where it has replaced the patch
};

// One law takes over from the other: the patch's contacts are (1 - weight) of their springs, the spheres' `weight` of
// the pair's.
class DeepContact final : public Effect {
 public:
  explicit DeepContact(const Parameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] std::uint32_t needs() const noexcept override { return need_patch; }
  [[nodiscard]] std::uint32_t stages() const noexcept override { return stage_meeting; }
  [[nodiscard]] std::string_view evaluates() const noexcept override { return "pairs of solids"; }
  [[nodiscard]] std::string_view rests_on() const noexcept override { return "contact"; }

  [[nodiscard]] std::optional<Error> bind(const ode::World& world) override {
    std::map<const query::Shape*, const query::InnerSpheres*> known;
    packed_.clear();
    of_body_.assign(world.body_count(), nullptr);
    std::size_t solids = 0;
    std::optional<Error> too_thin;
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      const std::shared_ptr<const query::Shape>& shape = world.shape({i});
      if (!shape->is_solid()) continue;
      auto [entry, is_new] = known.try_emplace(shape.get(), nullptr);
      if (is_new) {
        auto packed = query::InnerSpheres::pack(shape, static_cast<std::uint32_t>(parameters_.spheres));
        if (!packed) {  // too thin to hold any: it keeps its patches, as an open mesh does
          too_thin = Error{"", "",
                           "'deep_contact' needs two bodies with spheres in them, and '" + shape->mesh().name() +
                               "' is too thin to hold a sphere",
                           "leave it out, or make the mesh thicker"};
          continue;
        }
        packed_.push_back(std::make_unique<const query::InnerSpheres>(std::move(packed).value()));
        entry->second = packed_.back().get();
      }
      of_body_[i] = entry->second;
      if (entry->second != nullptr) ++solids;
    }
    if (solids < 2) {
      if (too_thin) return too_thin;
      return Error{"", "", "'deep_contact' needs two bodies with closed meshes; of others the inside is not known",
                   "leave it out, or close the meshes ('odds inspect' shows where they are open)"};
    }
    return std::nullopt;
  }

  std::uint32_t meet(const TickView& tick, ode::Meeting& meeting) noexcept override {
    const query::InnerSpheres* a = of_body_[meeting.a.index];
    const query::InnerSpheres* b = of_body_[meeting.b.index];
    if (a == nullptr || b == nullptr) return 0;
    const math::Pose pose_a = tick.world->state(meeting.a).pose;
    const query::DeepOverlap overlap =
        query::deep_overlap(*a, *b, pose_a.inverse() * tick.world->state(meeting.b).pose);
    const double thickness = std::min(a->thickness(), b->thickness());
    const double way = (overlap.depth / thickness - parameters_.from) / (parameters_.full - parameters_.from);
    if (!(way > 0.0)) return 1;
    const double x = std::min(1.0, way);
    const double weight = x * x * (3.0 - 2.0 * x);
    take_over(*tick.world, overlap, pose_a, weight, meeting);
    return 1;
  }

 private:
  // The spheres' contacts come first: where the world has room for no more, it is the fading ones that are left out.
  static void take_over(const ode::World& world, const query::DeepOverlap& overlap, const math::Pose& pose_a,
                        double weight, ode::Meeting& meeting) noexcept {
    std::array<ode::ContactPoint, query::InnerSpheres::corners> patch;
    const std::size_t of_patch = weight < 1.0 ? std::min(meeting.contacts.size(), patch.size()) : 0;
    std::copy_n(meeting.contacts.begin(), of_patch, patch.begin());
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < overlap.count && count < meeting.room.size(); ++i) {
      const query::DeepOverlap::Part& part = overlap.parts[i];
      const double push = part.push.norm();
      if (!(push > 0.0)) continue;
      ode::ContactPoint& point = meeting.room[count++];
      point = {};
      point.position_m = pose_a * part.position;
      point.normal = pose_a.rotation * (part.push / push);
      point.depth_m = overlap.depth;  // of all alike, so that a bound of the correcting velocity turns no force
      point.surface.stiffness_n_per_m = weight * push * meeting.stiffness_n_per_m;
      point.surface.damping_ns_per_m = weight * push * meeting.damping_ns_per_m;
      point.surface.friction = world.options().contact.friction;
      point.velocity_m_per_s =
          velocity_at(world, meeting.a, point.position_m) - velocity_at(world, meeting.b, point.position_m);
    }
    for (std::size_t i = 0; i < of_patch && count < meeting.room.size(); ++i) {
      ode::ContactPoint& point = meeting.room[count++] = patch[i];
      point.surface.stiffness_n_per_m *= 1.0 - weight;
      point.surface.damping_ns_per_m *= 1.0 - weight;
    }
    meeting.contacts = meeting.room.first(count);
  }
  static Vec3 velocity_at(const ode::World& world, ode::BodyId body, const Vec3& place) noexcept {
    if (!world.is_dynamic(body)) return Vec3::Zero();
    const ode::BodyState state = world.state(body);
    const Vec3 arm = place - state.pose * world.mass(body).center_m;
    return state.velocity_m_per_s + state.angular_velocity_rad_per_s.cross(arm);
  }

  Parameters parameters_;
  std::vector<std::unique_ptr<const query::InnerSpheres>> packed_;
  std::vector<const query::InnerSpheres*> of_body_;  // null: no solid
};

}  // namespace

Result<std::unique_ptr<Effect>> make_deep_contact(const EffectRequest& request) {
  SettingsReader reader(*request.settings);
  Parameters parameters;
  reader.integer("spheres", query::InnerSpheres::fewest, query::InnerSpheres::most, parameters.spheres);
  reader.number("from", Range::positive(), parameters.from);
  reader.number("full", Range::positive(), parameters.full);
  if (!(parameters.full > parameters.from)) {
    reader.reject("full", "the spheres take over at no depth", "give more than 'from'");
  }
  if (auto error = reader.finish()) return *error;
  return std::unique_ptr<Effect>(std::make_unique<DeepContact>(parameters));
}

}  // namespace odds::haptics::effects
