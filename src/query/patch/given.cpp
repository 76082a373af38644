// Which patches bear, and which of their contacts are given.
#include <algorithm>
#include <array>
#include <limits>

#include "odds/math/tolerances.hpp"
#include "query/patch/scratch.hpp"

namespace odds::query {
namespace {

using patch::Patch;
using patch::Watch;

/// A rod that lies across an edge has a rim on either side of it; along one direction both lead to one summit.
bool are_one(const Contact& c, const Contact& d) noexcept {
  return (c.position - d.position).norm() <= tolerances::same_contact * d.depth &&
         c.normal.dot(d.normal) > tolerances::same_face;
}

/// Of more patches than contacts are wanted, puts first, behind the deepest, those that are far from each other in
/// place or in direction, the deeper ones rather: a body on many feet must not be held by those of one side.
void spread_out(std::span<Patch*> order, std::size_t wanted, Watch& watch) noexcept {
  Vec3 lower = order[0]->centre;
  Vec3 upper = lower;
  for (const Patch* p : order) {
    lower = lower.cwiseMin(p->centre);
    upper = upper.cwiseMax(p->centre);
  }
  const double lever = 0.5 * (upper - lower).norm();
  const double deepest = order[0]->depth;
  std::array<double, patch::Components::most> nearest;  // of those that are taken
  nearest.fill(std::numeric_limits<double>::infinity());
  for (std::size_t taken = 1; taken < wanted && !watch.late(); ++taken) {
    const Patch& last = *order[taken - 1];
    std::size_t best = taken;
    double most = -1.0;
    for (std::size_t i = taken; i < order.size(); ++i) {
      const Patch& p = *order[i];
      nearest[i] = std::min(nearest[i], (p.centre - last.centre).norm() + lever * (p.normal - last.normal).norm());
      const double worth = (deepest > 0.0 ? 0.5 + 0.5 * p.depth / deepest : 1.0) * nearest[i];
      if (!(worth > most)) continue;
      most = worth;
      best = i;
    }
    std::swap(order[taken], order[best]);
    std::swap(nearest[taken], nearest[best]);
  }
}

}  // namespace

/// Faces that are flush to within rounding leave crumbs of a rim between them, closed ones too, whose normals are those
/// of the faces. Beside a patch that bears they are left out.
void PatchBuilder::Scratch::drop_crumbs() noexcept {
  double deepest = 0.0;
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = -lower;
  for (std::size_t i = 0; i < patch_count; ++i) {
    deepest = std::max(deepest, patches[i].depth);
    lower = lower.cwiseMin(patches[i].lower);
    upper = upper.cwiseMax(patches[i].upper);
  }
  const double limit =
      std::min(tolerances::shallow_patch * deepest, tolerances::bears_nothing * (upper - lower).maxCoeff());
  for (std::size_t i = 0; i < patch_count; ++i) patches[i].dropped = patches[i].depth < limit;
}

/// Two patches that push against each other through the same stuff (a rod that has run through a plate) cannot both be
/// obeyed: the shorter way out stays.
void PatchBuilder::Scratch::drop_opposed(const Vec3* previous, Watch& watch) noexcept {
  const auto cost = [previous](const Patch& p) noexcept {
    return p.depth *
           (previous != nullptr && previous->dot(p.normal) > tolerances::same_as_before ? tolerances::hysteresis : 1.0);
  };
  for (std::size_t i = 0; i < patch_count; ++i) {
    static_cast<void>(watch.late(i));  // work over several queries pauses here
    for (std::size_t j = i + 1; j < patch_count; ++j) {
      Patch& p = patches[i];
      Patch& q = patches[j];
      if (p.dropped || q.dropped || p.normal.dot(q.normal) > tolerances::opposed) continue;
      if (p.in_corner && q.in_corner && p.component == q.component) continue;  // from both sides of a groove
      if ((p.lower.array() - p.depth > q.upper.array() + q.depth).any()) continue;
      if ((q.lower.array() - q.depth > p.upper.array() + p.depth).any()) continue;
      // Along p's normal p's overlap reaches down from its rim, q's up from its own.
      const double q_low = -q.high;
      const double q_high = -q.low;
      if (p.low > q_high || q_low > p.high) continue;
      (cost(q) < cost(p) ? p : q).dropped = true;
    }
  }
}

/// Deals the contacts out: every patch its first, the deepest patch first, then every patch its second, and so on.
void PatchBuilder::Scratch::write(const PatchInput& input, Watch& watch) noexcept {
  std::array<Patch*, patch::Components::most> order{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < patch_count; ++i) {
    if (!patches[i].dropped && patches[i].chosen.count > 0) order[count++] = &patches[i];
  }
  const auto rank = [&input](const Patch* p) noexcept {
    const bool before =
        input.previous_normal != nullptr && input.previous_normal->dot(p->normal) > tolerances::same_as_before;
    return before ? p->depth * tolerances::keep_first : p->depth;
  };
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
            [&rank](const Patch* p, const Patch* q) { return rank(p) != rank(q) ? rank(p) > rank(q) : p < q; });
  const std::size_t wanted = most_wanted;
  if (count > wanted) spread_out({order.data(), count}, wanted, watch);
  if (count >= wanted) {
    count = wanted;  // one contact a patch: at its middle, so that it bears without tipping
    for (std::size_t i = 0; i < count; ++i) {
      if (order[i]->chosen.count > 1)
        order[i]->chosen.witnesses[0] = patch::merged(order[i]->chosen, order[i]->normal, order[i]->centre);
      order[i]->chosen.count = 1;
    }
  }
  contact_count = 0;
  for (std::size_t round = 0; round < most_contacts; ++round) {
    for (std::size_t i = 0; i < count && contact_count < wanted; ++i) {
      if (round >= order[i]->chosen.count) continue;
      const patch::Witness& w = order[i]->chosen.witnesses[round];
      const Contact contact{w.middle(), order[i]->normal, w.depth, w.triangle_a, w.triangle_b};
      const std::span<const Contact> given(contacts.data(), contact_count);
      if (std::none_of(given.begin(), given.end(), [&](const Contact& c) noexcept { return are_one(c, contact); })) {
        contacts[contact_count++] = contact;
      }
    }
  }
}

}  // namespace odds::query
