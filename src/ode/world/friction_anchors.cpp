#include "ode/world/friction_anchors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <new>
#include <span>

#include "odds/math/pose.hpp"
#include "ode/last_error.hpp"
#include "ode/pair_hash.hpp"
#include "ode/vectors.hpp"

namespace {

namespace math = odds::math;
using odds::Mat3;
using odds::Vec3;
using odds::ode::vector_of;

/// Of what has been slid, taken back in a step: ODE's usual ERP.
constexpr double taken_back = 0.2;
/// Steps that a pair may be apart and still be held where it was: bodies that rock lose their contacts for a step or
/// two.
constexpr std::uint64_t most_apart = 16;
/// Slots for a pair: those of this step and of the one before are not given away, a quarter of all at most.
constexpr std::size_t slots_of_a_pair = 8;
/// Slots that are looked at for a pair: a run of as many that are in use is as good as never met. (With half of all in
/// use one step of 1,024 pairs in some hundreds met one.)
constexpr std::size_t most_looked_at = 32;

/// Two directions in which a contact's friction acts, as ODE chooses them, and whose velocity along them its motion1
/// and motion2 are: of b1 against b2, but of b2 where b1 is the world.
struct FrictionAxes {
  Vec3 first;
  Vec3 second;
  double sign;

  FrictionAxes(const dContact& contact, bool b1_is_world) noexcept : sign(b1_is_world ? -1.0 : 1.0) {
    const Vec3 normal = sign * vector_of(contact.geom.normal);
    if ((contact.surface.mode & dContactFDir1) != 0) {
      first = vector_of(contact.fdir1);
      second = normal.cross(first);
      return;
    }
    const dVector3 n = {normal.x(), normal.y(), normal.z(), 0};
    dVector3 p = {};
    dVector3 q = {};
    dPlaneSpace(n, p, q);
    first = vector_of(p);
    second = vector_of(q);
  }
};

double motion1_of(const dSurfaceParameters& surface) noexcept {
  return (surface.mode & dContactMotion1) != 0 ? double{surface.motion1} : 0.0;
}
double motion2_of(const dSurfaceParameters& surface) noexcept {
  return (surface.mode & dContactMotion2) != 0 ? double{surface.motion2} : 0.0;
}

/// Null: the world.
math::Pose pose_of(dBodyID body) noexcept {
  if (body == nullptr) return {};
  return {odds::ode::matrix_of(dBodyGetRotation(body)), vector_of(dBodyGetPosition(body))};
}

/// The velocity of b1 against b2 that a contact asks for, as of a conveyor, m/s.
Vec3 asked_of(const dContact& contact, bool b1_is_world) noexcept {
  if ((contact.surface.mode & (dContactMotion1 | dContactMotion2)) == 0) return Vec3::Zero();
  const FrictionAxes axes(contact, b1_is_world);
  const auto along = [](const Vec3& axis, double speed) -> Vec3 {
    const double squared = axis.squaredNorm();  // a direction of the caller's may have any length
    return squared > 0.0 ? Vec3(speed / squared * axis) : Vec3(Vec3::Zero());
  };
  return axes.sign * (along(axes.first, motion1_of(contact.surface)) + along(axes.second, motion2_of(contact.surface)));
}

/// Whether it was longer.
bool limit(Vec3& v, double most) noexcept {
  const double length = v.norm();
  if (!(length > most)) return false;
  v *= most / length;
  return true;
}

bool is_finite(dBodyID body) noexcept {
  const math::Pose pose = pose_of(body);
  return pose.translation.allFinite() && pose.rotation.allFinite();
}

bool is_finite(const dContact& contact) noexcept {
  const Vec3 normal = vector_of(contact.geom.normal);
  // Of none ODE's directions of friction are not numbers either.
  return vector_of(contact.geom.pos).allFinite() && normal.allFinite() && !normal.isZero(0.0) &&
         ((contact.surface.mode & dContactFDir1) == 0 || vector_of(contact.fdir1).allFinite()) &&
         std::isfinite(motion1_of(contact.surface)) && std::isfinite(motion2_of(contact.surface));
}

int refuse(const char* rule) noexcept {
  odds::ode::set_last_error(rule);
  return 0;
}

}  // namespace

/// The middle of all contacts.
struct oddsFrictionAnchors::Middle {
  Vec3 place = Vec3::Zero();
  Vec3 normal = Vec3::Zero();      ///< unit, into the pair's first body; zero where contacts push against each other
  Vec3 asked = Vec3::Zero();       ///< mean velocity of b1 against b2 that they ask for, m/s
  Vec3 asked_spin = Vec3::Zero();  ///< the same of the spin about the normal, rad/s: of a turntable

  /// `sign`: 1 where b1 is the pair's first body, else -1. What a pair has turned is kept from step to step, and a
  /// space may give its geoms in another order in the next.
  Middle(const dContact* contacts, int count, bool b1_is_world, double sign) noexcept {
    constexpr double one_way = 0.1;  // of the sum of normals: less, and they hold from both sides
    for (int i = 0; i < count; ++i) {
      place += vector_of(contacts[i].geom.pos) / count;
      normal += sign * vector_of(contacts[i].geom.normal) / count;
      asked += asked_of(contacts[i], b1_is_world) / count;
    }
    normal = normal.norm() > one_way ? Vec3(normal.normalized()) : Vec3(Vec3::Zero());
    Vec3 moment = Vec3::Zero();
    double squares = 0.0;
    for (int i = 0; i < count; ++i) {
      const Vec3 arm = vector_of(contacts[i].geom.pos) - place;
      moment += arm.cross(asked_of(contacts[i], b1_is_world));
      squares += arm.squaredNorm();
    }
    if (squares > 0.0) asked_spin = normal.dot(moment) / squares * normal;
    contacts_ = {contacts, static_cast<std::size_t>(count)};
  }
  /// Distance of the farthest contact.
  [[nodiscard]] double reach_from(const Vec3& point) const noexcept {
    double reach = 0.0;
    for (const dContact& contact : contacts_) reach = std::max(reach, (vector_of(contact.geom.pos) - point).norm());
    return reach;
  }

 private:
  std::span<const dContact> contacts_;
};

/// World frame.
struct oddsFrictionAnchors::Slid {
  Vec3 place;  ///< of the first body's point
  Vec3 by;     ///< there
  Vec3 turn;   ///< about the normal
};

oddsFrictionAnchors::oddsFrictionAnchors(std::size_t most_pairs, double most_slip_m)
    : most_slip_m_(most_slip_m), anchors_(std::bit_ceil(slots_of_a_pair * most_pairs)) {}

oddsFrictionAnchors::Anchor* oddsFrictionAnchors::find(const Touching& pair) noexcept {
  const std::uint64_t key = odds::ode::hash_of_pair(pair.geoms[0], pair.geoms[1]);
  Anchor* oldest = nullptr;
  for (std::size_t i = 0; i < std::min(most_looked_at, anchors_.size()); ++i) {
    Anchor& anchor = anchors_[(key + i) & (anchors_.size() - 1)];
    if (anchor.pair == pair && anchor.step + most_apart >= step_) return &anchor;
    if (oldest == nullptr || anchor.step < oldest->step) oldest = &anchor;
  }
  if (oldest->step + 1 >= step_) return nullptr;  // all of this step, or of the one before
  *oldest = {};
  oldest->pair = pair;
  return oldest;
}

oddsFrictionAnchors::Slid oddsFrictionAnchors::follow(Anchor& anchor, const Middle& middle, double sign,
                                                      double step_s) const noexcept {
  constexpr double small_angle = 0.1;
  const double least_reach = 10.0 * most_slip_m_;
  const math::Pose first = pose_of(anchor.pair.bodies[0]);
  const math::Pose second = pose_of(anchor.pair.bodies[1]);
  const Mat3 turned = second.rotation.transpose() * first.rotation;
  const bool is_new = anchor.met == step_;
  Vec3 place = is_new ? middle.place : first * anchor.points[0];
  Vec3 by = Vec3::Zero();
  double turn = 0.0;
  bool moves = is_new;
  if (!is_new) {
    by = place - second * anchor.points[1];
    by -= middle.normal.dot(by) * middle.normal;
    const Mat3 since = turned * anchor.turned.transpose();
    const Vec3 twice_sine(since(2, 1) - since(1, 2), since(0, 2) - since(2, 0), since(1, 0) - since(0, 1));
    turn = anchor.turn + 0.5 * middle.normal.dot(second.rotation * twice_sine);
    moves = twice_sine.norm() > 2.0 * small_angle;
    const bool is_carried = !middle.asked.isZero() || !middle.asked_spin.isZero();
    if (is_carried && anchor.step != step_) {  // what was asked for has come in the step since
      by -= sign * step_s * middle.asked;
      turn -= sign * step_s * middle.normal.dot(middle.asked_spin);
      moves = true;
    }
    // A body that rolls touches elsewhere now; one that rocks does so within what its contacts reach.
    if ((middle.place - place).norm() > std::max(anchor.reach, least_reach)) {
      place = middle.place;
      anchor.reach = 0.0;
      moves = true;
    }
  }
  anchor.reach = std::max(anchor.reach, middle.reach_from(place));
  const double most_turn = anchor.reach > 0.0 ? most_slip_m_ / anchor.reach : 0.0;  // one contact holds no turn
  const bool slips = limit(by, most_slip_m_) || std::abs(turn) > most_turn;
  turn = std::clamp(turn, -most_turn, most_turn);
  if (moves || slips) {
    anchor.points[0] = first.inverse() * place;
    anchor.points[1] = second.inverse() * Vec3(place - by);
    anchor.turned = turned;
    anchor.turn = turn;
  }
  return {place, by, turn * middle.normal};
}

bool oddsFrictionAnchors::hold(dBodyID b1, dBodyID b2, dContact* contacts, int count, double step_s) noexcept {
  const bool in_order = std::less<>{}(contacts[0].geom.g1, contacts[0].geom.g2);
  Touching pair{{contacts[0].geom.g1, contacts[0].geom.g2}, {b1, b2}};
  if (!in_order) pair = {{pair.geoms[1], pair.geoms[0]}, {b2, b1}};
  Anchor* const anchor = find(pair);
  if (anchor == nullptr) return false;
  if (anchor->step == 0) anchor->met = step_;
  const double sign = in_order ? 1.0 : -1.0;
  const Slid slid = follow(*anchor, Middle(contacts, count, b1 == nullptr, sign), sign, step_s);
  anchor->step = step_;
  for (int i = 0; i < count; ++i) {
    Vec3 here = slid.by + slid.turn.cross(vector_of(contacts[i].geom.pos) - slid.place);
    limit(here, most_slip_m_);
    if (!here.allFinite()) {
      anchor->step = 0;
      here.setZero();
    }
    const FrictionAxes axes(contacts[i], b1 == nullptr);
    const Vec3 back = -axes.sign * sign * taken_back / step_s * here;
    dSurfaceParameters& surface = contacts[i].surface;
    // Along an axis with slip of its own (dContactSlip1, 2) the bodies are meant to slide.
    if ((surface.mode & dContactSlip1) == 0) {
      surface.motion1 = motion1_of(surface) + back.dot(axes.first);
      surface.mode |= dContactMotion1;
    }
    if ((surface.mode & dContactSlip2) == 0) {
      surface.motion2 = motion2_of(surface) + back.dot(axes.second);
      surface.mode |= dContactMotion2;
    }
  }
  return true;
}

oddsFrictionAnchorsID oddsFrictionAnchorsCreate(int most_pairs, dReal most_slip) noexcept {
  if (most_pairs < 1 || most_pairs > 1048576 || !(most_slip > 0) || !std::isfinite(most_slip)) {
    refuse("oddsFrictionAnchorsCreate: needs 1 .. 1048576 pairs, and a slip > 0 metres");
    return nullptr;
  }
  try {
    return new oddsFrictionAnchors(static_cast<std::size_t>(most_pairs), most_slip);
  } catch (const std::bad_alloc&) {
    refuse("oddsFrictionAnchorsCreate: out of memory");
    return nullptr;
  }
}

void oddsFrictionAnchorsDestroy(oddsFrictionAnchorsID anchors) noexcept { delete anchors; }

void oddsFrictionAnchorsNextStep(oddsFrictionAnchorsID anchors) noexcept {
  if (anchors != nullptr) anchors->next_step();
}

int oddsFrictionAnchorsHold(oddsFrictionAnchorsID anchors, dBodyID b1, dBodyID b2, dContact* contacts, int count,
                            dReal step_s) noexcept {
  if (anchors == nullptr || count < 0) return refuse("oddsFrictionAnchorsHold: needs anchors and a count >= 0");
  if (count == 0 || (b1 == nullptr && b2 == nullptr)) return 1;
  if (contacts == nullptr) return refuse("oddsFrictionAnchorsHold: the contacts are null");
  if (b1 == b2) return refuse("oddsFrictionAnchorsHold: needs two bodies, at most one of them null");
  if (!(step_s > 0) || !std::isfinite(step_s) || !std::isfinite(1.0 / step_s)) {
    return refuse("oddsFrictionAnchorsHold: the step must be > 0 seconds");
  }
  if (!is_finite(b1) || !is_finite(b2)) return refuse("oddsFrictionAnchorsHold: a body is not finite");
  for (int i = 0; i < count; ++i) {
    if (contacts[i].geom.g1 != contacts[0].geom.g1 || contacts[i].geom.g2 != contacts[0].geom.g2) {
      return refuse("oddsFrictionAnchorsHold: the contacts must be of one pair of geoms, in one order");
    }
    if (!is_finite(contacts[i])) return refuse("oddsFrictionAnchorsHold: a contact is not finite, or has no normal");
  }
  if (!anchors->hold(b1, b2, contacts, count, step_s)) {
    return refuse("oddsFrictionAnchorsHold: no room for one more pair; create anchors for more");
  }
  return 1;
}
