#include "ode/collide/corners_below.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "query/shape/bound_along.hpp"
#include "query/shape/convex_region.hpp"
#include "query/shape/near_segment.hpp"
#include "query/wide/searches.hpp"

namespace odds::ode {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();
// Relative to the mesh's size: vertices this close count as equally deep. Far above rounding, far below what a contact
// can feel; without it the deepest corner of a flat face would jump about with the last bit.
constexpr double same_depth = 1e-6;
// What is kept of the time when gathering is ended by it, microseconds: for the deepest of all, more if there may be
// nothing else, and for choosing, which looks at each some fifteen times, beside what the limit keeps for that.
constexpr double time_for_any = 2.8;
constexpr double time_for_deepest = 1.0;
constexpr double time_for_each = 0.006;
// One unit of work in so many is kept likewise.
constexpr std::uint64_t work_share_for_rest = 3;
// To what lies beside a corner, nodes.
constexpr std::uint64_t nodes_beside = 16;
// Of the search for the deepest: it is to come to a leaf, or a body would sink in unnoticed.
constexpr int sure_nodes = 12;
// Of the size of what has been gathered: by so much one of many corners may be less far out than another, though by no
// more than the depth. A body that rests is held at its corners, always the same.
constexpr double rough_share = 0.03;

using OfLanes = query::CornerSearch::OfLanes;
using query::BoundAlong;
using query::wide::Extents;

// Of the distance from a point, across a unit direction, squared, of what comes with the height along it. In units, so
// that squares of floats neither vanish nor overflow.
class BoundAcross {
 public:
  BoundAcross(const query::CornerSearch& search, const Vec3& from, const Vec3& along, double per_unit) noexcept
      : scale_(static_cast<float>(per_unit)),
        from_((per_unit * from).cast<float>()),
        along_(along.cast<float>()),
        margin_(scale_ * search.margin() + 16.0F * 0x1p-24F * (1.0F + from_.norm())),
        for_height_(static_cast<float>(deeper_at_one_place) * (2.0F + from_.norm())) {}

  [[nodiscard]] double excess() const noexcept {
    constexpr double farthest = 1.0;  // no two corners are farther apart
    return 4.0 * farthest * static_cast<double>(margin_) + 2.0 * static_cast<double>(for_height_);
  }

  void of(const tree::WideNode& node, OfLanes& most) const noexcept {
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) {
      const float x = scale_ * node.half[0][k];
      const float y = scale_ * node.half[1][k];
      const float z = scale_ * node.half[2][k];
      most[k] = bound(node.center[0][k], node.center[1][k], node.center[2][k], std::sqrt(x * x + y * y + z * z));
    }
  }
  void of(const tree::WideLeaf& leaf, const Vec3f& center, OfLanes& most) const noexcept {
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) {
      most[k] = 0.0F;
      for (std::size_t c = 0; c < 3; ++c) {
        most[k] = std::max(most[k], bound(center[0] + leaf.corner[c][0][k], center[1] + leaf.corner[c][1][k],
                                          center[2] + leaf.corner[c][2][k], 0.0F));
      }
    }
  }

 private:
  // Of what is within `reach` units of a point.
  [[nodiscard]] float bound(float px, float py, float pz, float reach) const noexcept {
    const float x = scale_ * px - from_[0];
    const float y = scale_ * py - from_[1];
    const float z = scale_ * pz - from_[2];
    const float height = x * along_[0] + y * along_[1] + z * along_[2];
    const float farthest = std::sqrt(std::max(x * x + y * y + z * z - height * height, 0.0F)) + reach + margin_;
    return farthest * farthest + for_height_;
  }

  float scale_;
  Vec3f from_;
  Vec3f along_;
  float margin_;
  float for_height_;
};

// The same as another bound, of what is not wholly above a plane {x : normal . x = highest}.
template <class Bound>
class BoundBelow {
 public:
  BoundBelow(const Bound& bound, const query::CornerSearch& search, const Vec3& normal, double highest) noexcept
      : kernels_(search.kernels()),
        bound_(bound),
        normal_(normal.cast<float>()),
        highest_(static_cast<float>(highest) + search.margin()) {}

  void of(const tree::WideNode& node, OfLanes& most) const noexcept {
    Extents heights;
    bound_.of(node, most);
    kernels_.extents_of_children(node, normal_, heights);
    leave_out_above(heights, most);
  }
  void of(const tree::WideLeaf& leaf, const Vec3f& center, OfLanes& most) const noexcept {
    Extents heights;
    bound_.of(leaf, center, most);
    kernels_.extents_of_triangles(leaf, center, normal_, heights);
    leave_out_above(heights, most);
  }

 private:
  void leave_out_above(const Extents& heights, OfLanes& most) const noexcept {
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) {
      most[k] = heights.least[k] <= highest_ ? most[k] : -std::numeric_limits<float>::infinity();
    }
  }

  const query::wide::Searches& kernels_;
  const Bound& bound_;
  Vec3f normal_;
  float highest_;
};

// The same as another bound, of what exceeds so much.
template <class Bound>
class BoundOver {
 public:
  BoundOver(const Bound& bound, double least) noexcept : bound_(bound), least_(least) {}

  void of(const tree::WideNode& node, OfLanes& most) const noexcept {
    bound_.of(node, most);
    leave_out(most);
  }
  void of(const tree::WideLeaf& leaf, const Vec3f& center, OfLanes& most) const noexcept {
    bound_.of(leaf, center, most);
    leave_out(most);
  }

 private:
  void leave_out(OfLanes& most) const noexcept {
    for (float& x : most) x = static_cast<double>(x) > least_ ? x : -std::numeric_limits<float>::infinity();
  }

  const Bound& bound_;
  double least_;
};

}  // namespace

CornersBelow::CornersBelow(const PreparedMesh& mesh, const Vec3& normal, double offset, const Known& known,
                           Limit& limit) noexcept
    : tree_(*mesh.wide_tree),
      size_(mesh.mesh().size()),
      search_(mesh.mesh(), tree_),
      normal_(normal),
      offset_(offset - normal.dot(tree_.origin())),
      rounding_(4e-15 * (std::abs(offset) + tree_.origin().norm())),
      limit_(limit) {
  is_gathered_ = gather(!known.corners.empty());
  if (!is_gathered_) look_for_more(known);
  deepest_ = deepest_gathered();
  if (are_many_) rough_ = std::min(rough_share * gathered_.size(), deepest_ == no_item ? 0.0 : depth(deepest_));
}

void CornersBelow::look_for_more(const Known& known) noexcept {
  add_known(known.corners);
  if (!known.corners.empty()) add_beside(deepest_gathered());
  const std::uint32_t deepest = deepest_gathered();
  const std::uint32_t deeper = find_deeper(deepest == no_item ? -offset_ : -normal_.dot(position(deepest)));
  if (deeper != no_item) add(deeper);  // one more than there is room for
  // What lies beside each other holds no body that has a broad bottom. The search was short if the deepest was known.
  if (gathered_.is_full() || !has_some_left()) return;
  const std::uint32_t farther_out = find_farther_out(known.turn);
  if (farther_out != no_item) add(farther_out);
}

void CornersBelow::add_known(std::span<const std::uint32_t> known) noexcept {
  for (const std::uint32_t corner : known) {
    const bool exists = query::CornerSearch::triangle_of(corner) < tree_.triangle_count();
    if (exists && !gathered_.is_full() && depth(corner) >= 0.0) add(corner);
  }
}

void CornersBelow::add_beside(std::uint32_t corner) noexcept {
  if (corner == no_item || gathered_.is_full() || !has_some_left()) return;
  const Vec3 place = position(corner) + tree_.origin();
  const std::uint64_t nodes = limit_.nodes_left();
  std::uint64_t left = nodes;
  const auto take = [this](std::uint32_t triangle) {
    for (std::uint32_t beside = 3 * triangle; beside < 3 * triangle + 3; ++beside) {
      if (!(depth(beside) >= 0.0)) continue;
      if (gathered_.is_full()) return false;
      add(beside);
    }
    return true;
  };
  const auto may_go_on = [this] { return has_time_to_search(); };
  static_cast<void>(query::NearSegment(search_.mesh(), tree_, place, place).all_within(0.0, take, may_go_on, left));
  limit_.spend(nodes - left);
}

std::uint32_t CornersBelow::deepest_gathered() const noexcept {
  return corner_of(search_.kernels().outermost_along(gathered_.all(), -normal_, 0.0, 0.0, 1));
}

template <class Value, class Bounds>
std::uint32_t CornersBelow::search_over(double least, double excess, const Value& value,
                                        const Bounds& bounds) const noexcept {
  int asked = 0;
  const std::uint64_t nodes = limit_.nodes_left();
  std::uint64_t left = nodes;
  const std::uint32_t found = search_.greatest(
      excess,
      [&](const Vec3& x) {
        const double v = value(x);
        return v > least ? v : nothing;
      },
      BoundOver(bounds, least + excess), [&] { return ++asked <= sure_nodes || has_time_to_search(); }, left);
  limit_.spend(nodes - left);
  return found;
}

std::uint32_t CornersBelow::find_deeper(double least) const noexcept {
  const BoundAlong bound(search_, -normal_);
  return search_over(
      least, bound.excess(), [&](const Vec3& x) { return -normal_.dot(x); }, bound);
}

std::uint32_t CornersBelow::find_farther_out(std::uint32_t turn) const noexcept {
  constexpr double golden_angle = 2.399963229728653;  // radians: no two turns look the same way
  const Vec3 across = normal_.unitOrthogonal();
  const double angle = golden_angle * static_cast<double>(turn);
  const Vec3 outwards = std::cos(angle) * across + std::sin(angle) * normal_.cross(across);
  const std::uint32_t known = search_.kernels().outermost_along(gathered_.all(), outwards, 0.0, 0.0, 1);
  if (known == no_item) return no_item;
  const BoundAlong bound(search_, outwards);
  return search_over(
      outwards.dot(position(corner_of(known))), bound.excess(),
      [&](const Vec3& x) { return normal_.dot(x) <= offset_ ? outwards.dot(x) : nothing; },
      BoundBelow(bound, search_, normal_, offset_ + rounding_));
}

bool CornersBelow::gather(bool is_any_known) noexcept {
  using Region = query::ConvexRegion;
  Region below(search_.mesh(), tree_, rounding_);
  below.add(normal_, offset_ + normal_.dot(tree_.origin()));
  const std::uint64_t all = limit_.nodes_left();
  const std::uint64_t nodes =
      all - std::max(all / work_share_for_rest, std::min(all / 2, is_any_known ? nodes_beside : 0));
  std::uint64_t left = nodes;
  const bool gathered_all = below.search(
      [&](tree::ChildRef, Region::Sides) {
        const double for_deepest = is_any_known || gathered_.count() > 0 ? time_for_deepest : time_for_any;
        return limit_.has_time_left(for_deepest + time_to_choose()) ? Region::Visit::open : Region::Visit::end;
      },
      [this](std::uint32_t triangle, Region::Sides) {
        for (std::uint32_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
          if (!(depth(corner) >= 0.0)) continue;
          are_many_ = gathered_.is_full();
          if (are_many_) return false;
          add(corner);
        }
        return true;
      },
      left);
  limit_.spend(nodes - left);
  return gathered_all;
}

std::uint32_t CornersBelow::first() const noexcept {
  if (deepest_ == no_item) return no_item;
  const double least_depth = std::max(0.0, depth(deepest_) - same_depth * size_);
  const std::uint32_t outermost = farthest_below(Vec3::Zero(), least_depth);
  return outermost != no_item ? outermost : deepest_;
}

std::uint32_t CornersBelow::extreme(const Vec3& direction) const noexcept {
  const double per_depth = deeper_at_one_place * direction.norm();
  if (!are_many_ || !has_some_left()) {
    return corner_of(search_.kernels().outermost_along(gathered_.all(), direction, per_depth, 0.0, step()));
  }
  const Vec3 downwards = direction - per_depth * normal_;
  return search(
      0.0, rough_ * direction.norm(), [&](const Vec3& x) { return downwards.dot(x); }, BoundAlong(search_, downwards),
      [this] { return has_time_to_search(); });
}

std::uint32_t CornersBelow::farthest_below(const Vec3& from, double least_depth) const noexcept {
  if (!are_many_ || !has_some_left()) {
    const double per_depth = deeper_at_one_place * size_;
    return corner_of(search_.kernels().outermost_from(gathered_.all(), from, normal_, per_depth, least_depth, step()));
  }
  // In sizes of the mesh, so that squares of floats neither vanish nor overflow.
  const double unit = 1.0 / size_;
  const auto value = [&](const Vec3& x) {
    const Vec3 d = unit * (x - from);
    const double height = d.dot(normal_);
    return (d - height * normal_).squaredNorm() - deeper_at_one_place * height;
  };
  return search(least_depth, 0.0, value, BoundAcross(search_, from, normal_, unit),
                [this] { return has_time_to_search(); });
}

double CornersBelow::time_to_choose() const noexcept {
  return time_for_each * static_cast<double>(gathered_.count() / step());
}

bool CornersBelow::has_time_to_search() const noexcept { return limit_.has_time_left(time_to_choose()); }

double GatheredVertices::size() const noexcept {
  double square = 0.0;
  for (std::size_t i = 1; i < count(); ++i) {
    square = std::max(square, (by_eight_.point(i) - by_eight_.point(0)).squaredNorm());
  }
  return std::sqrt(square);
}

template <class Value, class Bounds, class MayGoOn>
std::uint32_t CornersBelow::search(double least_depth, double not_greater, const Value& value, const Bounds& bounds,
                                   const MayGoOn& may_go_on) const noexcept {
  const double highest = offset_ - least_depth;
  const std::uint64_t nodes = limit_.nodes_left();
  std::uint64_t left = nodes;
  // Those that are as far out as each other need not all be looked at: the fine bottom of a body that stands.
  const std::uint32_t found = search_.greatest(
      std::max(not_greater, bounds.excess()),
      [&](const Vec3& x) { return normal_.dot(x) <= highest ? value(x) : nothing; },
      BoundBelow(bounds, search_, normal_, highest + rounding_), may_go_on, left);
  limit_.spend(nodes - left);
  return found;
}

}  // namespace odds::ode
