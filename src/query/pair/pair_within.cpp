#include "query/pair/pair_within.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "odds/math/tolerances.hpp"

namespace odds::query {
namespace {

/// What is believed of a shape within another, or without, that there is no time to look at: few pass through a surface
/// from one run to the next.
constexpr double stays_within = 0.9;

/// The contact that leads the inner one of two nested shapes out, by the `known` exit if there is no time to look for
/// another. Whether there is one.
bool make_way_out(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, double most_depth, bool enters,
                  const Exit& known, Pair::Implementation& pair, Spending& spending) noexcept {
  std::array<Vec3, 2> preferred;
  std::size_t count = 0;
  if (!pair.previous_normal.isZero()) preferred[count++] = -pair.previous_normal;
  // By the inner one: as it turns, the middle of what is around it goes far in its frame.
  const Vec3 came = pair.within == Within::b_in_a ? pair.known_depth.motion_of(meshes.pose().translation, meshes.pose())
                                                  : Vec3(-pair.known_depth.motion_of_a(meshes.pose()));
  if (enters && came.norm() > tolerances::resting_motion * smaller_size(pair)) preferred[count++] = -came.normalized();
  const std::optional<Contact> out =
      way_out(*pair.a, *pair.b, pose_b_in_a, pair.within, std::span(preferred).first(count), known, spending);
  pair.answer.contacts_complete = out.has_value();
  if (!out) return false;
  Contact& contact = pair.contacts.front();
  contact = *out;
  // It cannot be deeper than it has come: a body that was clear a moment ago is not thrown out of a mountain.
  contact.depth = std::min(contact.depth, most_depth);
  pair.answer.contacts = std::span(pair.contacts).first(1);
  pair.known_depth.note(meshes.pose(), contact.depth);
  pair.came.setZero();
  pair.apart_at.reset();
  pair.previous_normal = contact.normal;
  pair.previous_position = contact.position;
  return true;
}

}  // namespace

void note_clear(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                Pair::Implementation& pair) noexcept {
  pair.within = Within::neither;
  pair.previous_normal.setZero();
  pair.came.setZero();
  pair.apart_at = meshes.pose();
  pair.known_at = meshes.pose();
  pair.apart_last = true;
  pair.known_depth.note(meshes.pose(), 0.0);
  pair.haste.guessed.forget();
  if (!request.solids && may_be_within(*pair.a, *pair.b, pose_b_in_a)) pair.known_depth.forget();
}

bool answer_within(const PosedMeshes& meshes, const math::Pose& pose_b_in_a, const Request& request,
                   const math::Reaches& reaches, bool same, Pair::Implementation& pair, Spending& spending) noexcept {
  pair.within_is_of_front = false;
  if (!request.solids || request.polygon_free) return false;
  const bool before = pair.within == Within::b_in_a || pair.within == Within::a_in_b;
  const bool may_be = same ? before : may_be_within(*pair.a, *pair.b, pose_b_in_a);
  pair.within_is_of_front = request.method == Method::incremental;
  if (!may_be) return false;
  Answer& answer = pair.answer;
  spending.reserve_for_contacts(pair.endings.ray);
  Exit exit;
  const Within now = same ? pair.within : within(*pair.a, *pair.b, pose_b_in_a, exit, spending);
  if (now == Within::unknown) {
    pair.within_is_of_front = false;
    answer.basis = Basis::budget;
    answer.probability = before ? stays_within : 1.0 - stays_within;
    answer.verdict = before ? Verdict::hit : Verdict::clear;
  } else {
    pair.within = now;
    if (now != Within::neither) {
      answer.verdict = Verdict::hit;
      answer.probability = 1.0;
      pair.carried.forget();
      if (request.max_contacts > 0) {
        const double most_depth = pair.known_depth.most(meshes.pose(), reaches);
        if (!make_way_out(meshes, pose_b_in_a, most_depth, !before, exit, pair, spending)) {
          answer.basis = Basis::budget;
          answer.probability = stays_within;
        }
      }
    }
  }
  return now != Within::neither;
}

}  // namespace odds::query
