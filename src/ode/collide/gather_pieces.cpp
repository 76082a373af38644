#include "ode/collide/gather_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "ode/collide/convex_patch.hpp"
#include "ode/collide/end_of_share.hpp"
#include "ode/collide/sieve.hpp"
#include "ode/collide/surface_above.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "query/shape/near_segment.hpp"

namespace odds::ode {
namespace {

using Visit = Sieve::Visit;

constexpr std::size_t octants = 8;
constexpr std::size_t each = Pieces::most / (2 * octants);  // twice, from both ends of the tree
constexpr std::size_t any_octant = octants;
/// At the clock; in nodes: about half a microsecond, where the cache does not hold them.
constexpr std::uint64_t work_between_looks = 8;

/// Those of a tetrahedron first: any face of the body has two of them, opposite each other.
constexpr std::array<std::size_t, octants> in_order = {0, 3, 5, 6, 7, 4, 2, 1};

std::size_t octant_of(const Piece& piece, const Vec3& box_center) noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < piece.count; ++i) sum += piece.corners[i] - box_center;
  return (sum.x() > 0.0 ? 1U : 0U) + (sum.y() > 0.0 ? 2U : 0U) + (sum.z() > 0.0 ? 4U : 0U);
}

/// Towards an octant's corner of the box.
Vec3 signs_of(std::size_t octant) noexcept {
  return {(octant & 1U) != 0 ? 1.0 : -1.0, (octant & 2U) != 0 ? 1.0 : -1.0, (octant & 4U) != 0 ? 1.0 : -1.0};
}

/// Between the middle of a body's box and a corner of it.
Vec3 inner_point(const ConvexBody& body, std::size_t octant) noexcept {
  constexpr double outwards = 0.7;  // of the half extents
  return body.box_center() + outwards * signs_of(octant).cwiseProduct(body.box_half_extents());
}

/// From where pieces are looked for in a turn, and how far it is from there to the farthest corner of the body's box.
struct Start {
  Start(const ConvexBody& body, std::uint32_t turn) noexcept {
    const std::size_t of_turns = turn % (octants + 1);
    point = of_turns == 0 ? body.center() : inner_point(body, in_order[of_turns - 1]);
    reach = (body.box_half_extents() + (point - body.box_center()).cwiseAbs()).norm();
  }
  Vec3 point;
  double reach;
};

/// How many pieces there will be time for, and is room for.
std::size_t room_in_time(const Limit& limit) noexcept {
  return static_cast<std::size_t>(std::min<std::uint64_t>(Pieces::most, limit.nodes_in_time(time_for_pieces)));
}

class Gathering {
 public:
  Gathering(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, std::uint32_t turn,
            Limit& limit, Pieces& pieces) noexcept
      : mesh_(mesh),
        body_(body),
        mesh_in_body_(body_in_mesh.inverse()),
        turn_(turn),
        limit_(limit),
        pieces_(pieces),
        sieve_(mesh, body, body_in_mesh),
        nodes_a_cut_(1 + body.sides().size() / 32) {}

  void run() noexcept {
    if (limit_.nodes_in_time(time_for_pieces) < from_all_octants) return from_inner_points();
    if (!seem_more_than(room_in_time(limit_))) {
      end_share_ = time_for_pieces;
      const Way way = turn_ % 2 == 0 ? Way::forwards : Way::backwards;
      pieces_.complete = sift(any_octant, way, limit_.nodes_left(), Pieces::most);
      if (pieces_.complete || pieces_.cut_off) return;
      if (used_ >= time_for_pieces) {
        pieces_.cut_off = true;
        return;
      }
      pieces_.count = 0;
    }
    by_octants();
    if (pieces_.count > 0 || !has_spare_) return;
    pieces_.all[0] = spare_;
    pieces_.count = 1;
  }

 private:
  using Way = query::ConvexRegion::Way;
  static constexpr std::uint64_t from_all_octants = 40;  ///< nodes: from the root to some triangles of each

  /// Whether more triangles are in the body, as far as a part of the tree tells.
  [[nodiscard]] bool seem_more_than(std::size_t room) noexcept {
    constexpr std::size_t below_leaves = 40;  // of a node above them, as they usually are
    constexpr double counting_share = 0.5 * time_for_pieces;
    if (mesh_.mesh().triangles().size() <= Pieces::most) return false;
    std::size_t about = 0;
    const auto node = [&](tree::ChildRef child, Sieve::Sides sides) {
      if (is_late_for(counting_share)) {  // so many nodes, so many triangles
        about = room + 1;
        return Visit::end;
      }
      if (!child.is_leaf() && sides != 0) return Visit::open;
      const std::size_t half = child.is_leaf()       ? (child.count() + 1) / 2
                               : child.height() == 1 ? below_leaves
                                                     : Pieces::most;
      about += sides == 0 && child.is_leaf() ? child.count() : half;
      return about > room ? Visit::end : Visit::pass_over;
    };
    const auto take = [](std::uint32_t, Sieve::Sides) { return true; };
    const std::uint64_t nodes = limit_.nodes_left();
    std::uint64_t left = nodes;
    static_cast<void>(sieve_.region().search(node, take, left));
    limit_.spend(nodes - left);
    return about > room;
  }

  /// Adds the pieces in that octant, which the sieve is set to, but for those that are there; at most `most`. False if
  /// there are more, or the limit, or `nodes`, ended it: then `cut_off`.
  [[nodiscard]] bool sift(std::size_t octant, Way way, std::uint64_t nodes, std::size_t most) noexcept {
    const std::size_t before = pieces_.count;
    const std::size_t end = before + most;
    std::uint64_t left = nodes;
    // Without any piece a body falls through what it has just found.
    const auto is_late = [&](std::uint64_t work) {
      return is_late_for(pieces_.count == 0        ? time_for_exits
                         : pieces_.count == before ? time_for_pieces
                                                   : end_share_,
                         work);
    };
    const auto node = [&](tree::ChildRef, Sieve::Sides) { return is_late(1) ? Visit::end : Visit::open; };
    bool full = false;
    const auto take = [&](std::uint32_t triangle, Sieve::Sides sides) {
      if (has(triangle)) return true;
      if (is_late(2 * nodes_a_cut_)) return false;
      Piece& piece = pieces_.all[pieces_.count];
      if (!cut_triangle(mesh_, triangle, mesh_in_body_, body_, sieve_.of_body(sides), piece)) {
        // Where nothing was found yet, what is cut in vain must not use up all work.
        left -= std::min(left, pieces_.count == 0 ? 1 : nodes_a_cut_);
        return true;
      }
      left -= std::min(left, nodes_a_cut_);
      if (octant != any_octant && octant_of(piece, body_.box_center()) != octant) {
        if (pieces_.count == 0 && !has_spare_) spare_ = piece;
        has_spare_ = has_spare_ || pieces_.count == 0;
        return true;
      }
      full = pieces_.count == end;
      if (full) return false;
      ++pieces_.count;
      return true;
    };
    const bool all = sieve_.region().search(node, take, left, way);
    limit_.spend(nodes - left);
    pieces_.cut_off = pieces_.cut_off || !(all || full);
    return all;
  }
  /// Looks at the clock after some work.
  [[nodiscard]] bool is_late_for(double share, std::uint64_t work = 1) noexcept {
    if ((since_look_ += work) < work_between_looks) return false;
    since_look_ = 0;
    used_ = limit_.used();
    return used_ >= share;
  }
  [[nodiscard]] bool has(std::uint32_t triangle) const noexcept {
    const auto end = pieces_.all.begin() + static_cast<std::ptrdiff_t>(pieces_.count);
    return std::any_of(pieces_.all.begin(), end, [=](const Piece& piece) { return piece.triangle == triangle; });
  }

  /// Octant by octant, each its share of the room, from both ends of the tree: neighbours are often of one side of a
  /// plate. Then what is left of the room goes to those that need more. What lies beside the body in its box takes no
  /// place of what is in the body.
  void by_octants() noexcept {
    std::array<std::size_t, octants> hungry;
    std::rotate_copy(in_order.begin(), in_order.begin() + turn_ % octants, in_order.end(), hungry.begin());
    std::size_t hungry_count = octants;
    for (int round = 0; round < 3 && hungry_count > 0 && !pieces_.cut_off; ++round) {
      const bool last = round == 2;
      std::size_t still_hungry = 0;
      for (std::size_t i = 0; i < hungry_count; ++i) {
        if (used_ >= (pieces_.count > 0 ? time_for_pieces : 1.0)) {
          pieces_.cut_off = true;
          break;
        }
        const std::size_t turns = hungry_count - i;
        const std::size_t room = last ? (Pieces::most - pieces_.count) / turns : each;
        if (!find(hungry[i], round == 1 ? Way::backwards : Way::forwards, room, turns)) {
          hungry[still_hungry++] = hungry[i];
        }
      }
      hungry_count = still_hungry;
    }
    pieces_.complete = hungry_count == 0 && !pieces_.cut_off;
  }
  /// Where there is time for some nodes of each octant only: those nearest to the body's middle, or, in other turns, to
  /// another inner point, then those nearest to two more, which lie opposite each other. All that is near may be beside
  /// a flat or long body: then what is in it is looked for.
  void from_inner_points() noexcept {
    const Start start(body_, turn_);
    pieces_.complete = add_nearest(start.point, start.reach, 0.5 * time_for_pieces, EndOfShare::to_a_triangle);
    if (!pieces_.complete && pieces_.count == 0) {
      const std::uint64_t nodes = limit_.nodes_left() - limit_.nodes_left() / 4;  // the rest may have to push it out
      const Way way = turn_ % 2 == 0 ? Way::forwards : Way::backwards;
      pieces_.complete = sift(any_octant, way, nodes, Pieces::most);
      pieces_.cut_off = !pieces_.complete;
      return;
    }
    pieces_.cut_off = !pieces_.complete;
    constexpr double reach = 0.8;  // of the half diagonal: farther ones are nearer to other such points
    for (std::size_t i = 0; i < 2 && pieces_.cut_off; ++i) {
      const double share = time_for_pieces * (i == 0 ? 0.75 : 1.0);
      if (pieces_.count == Pieces::most || limit_.time_is_up(share)) continue;
      const Vec3 next = inner_point(body_, in_order[(turn_ % (octants + 1) + i) % octants]);
      static_cast<void>(add_nearest(next, reach * body_.box_half_extents().norm(), share, 0));
    }
  }
  /// Those nearest to a point of the body come first. True if there are no more within `reach`.
  [[nodiscard]] bool add_nearest(const Vec3& point, double reach, double share, int sure_nodes) noexcept {
    const Vec3 from = mesh_in_body_.inverse() * point;
    EndOfShare late(limit_, time_for_pieces, sure_nodes);
    EndOfShare end(limit_, share, 0);
    const auto may_go_on = [&] { return pieces_.count == 0 ? !late.is_there() : !end.is_there(); };
    const std::uint64_t nodes = limit_.nodes_left() / (pieces_.count == 0 ? 2 : 1);
    std::uint64_t left = nodes;
    const auto take = [&](std::uint32_t triangle) {
      if (pieces_.count == Pieces::most || (left == 0 && pieces_.count > 0)) return false;
      if (has(triangle)) return true;
      const bool is_in = cut_triangle(mesh_, triangle, mesh_in_body_, body_, all_sides, pieces_.all[pieces_.count]);
      if (is_in) ++pieces_.count;
      if (pieces_.count > 0) left -= std::min(left, nodes_a_cut_);  // until then, what is cut in vain is no work
      return may_go_on();
    };
    const bool all =
        query::NearSegment(mesh_.mesh(), *mesh_.wide_tree, from, from).all_within(reach, take, may_go_on, left);
    limit_.spend(nodes - left);
    return all;
  }
  [[nodiscard]] bool find(std::size_t octant, Way way, std::size_t most, std::size_t turns) noexcept {
    constexpr std::uint64_t least_nodes = 64;  // down to some triangles
    const std::uint64_t nodes = std::min(limit_.nodes_left(), std::max(least_nodes, limit_.nodes_left() / turns));
    end_share_ = used_ + (time_for_pieces - used_) / static_cast<double>(turns);
    sieve_.set_octant(octant);
    return sift(octant, way, nodes, most);
  }

  const PreparedMesh& mesh_;
  const ConvexBody& body_;
  math::Pose mesh_in_body_;
  std::uint32_t turn_;
  Limit& limit_;
  Pieces& pieces_;
  Sieve sieve_;
  std::uint64_t nodes_a_cut_;  ///< a cut takes as long as these: of a box's six sides as one
  double end_share_ = time_for_pieces;
  std::uint64_t since_look_ = 0;  ///< work
  double used_ = 0.0;             ///< of the time, at the last look
  Piece spare_;                   ///< found while another octant was looked at, and nothing else
  bool has_spare_ = false;
};

/// Of a body that many half-spaces bound, each node takes long. Those nearest to its middle are in it if any are, and
/// the deepest: they come first, and are found without the half-spaces. In other turns those nearest to another inner
/// point.
void gather_from_within(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body,
                        std::uint32_t turn, Limit& limit, Pieces& pieces) noexcept {
  const math::Pose mesh_in_body = body_in_mesh.inverse();
  const Start start(body, turn);
  const Vec3 from = body_in_mesh * start.point;
  const query::NearSegment about(mesh.mesh(), *mesh.wide_tree, from, from);
  const std::uint64_t nodes = limit.nodes_left();
  std::uint64_t left = nodes;
  EndOfShare late(limit, time_for_exits, EndOfShare::to_a_triangle, 1);
  EndOfShare end(limit, time_for_pieces, 0, 1);
  const auto may_go_on = [&] { return pieces.count == 0 ? !late.is_there() : !end.is_there(); };
  const auto take = [&](std::uint32_t triangle) {
    if (!may_go_on() || pieces.count == Pieces::most) return false;
    if (cut_triangle(mesh, triangle, mesh_in_body, body, all_sides, pieces.all[pieces.count])) ++pieces.count;
    return true;
  };
  pieces.nearest_first = true;
  pieces.complete = about.all_within(start.reach, take, may_go_on, left);
  pieces.cut_off = !pieces.complete;  // where only the room ends it, too: other turns have others
  limit.spend(nodes - left);
}

/// What may be nothing but its corners' rounding faces anywhere. It is left out where there is other surface, which has
/// its edges, too.
void leave_out_thin(const PreparedMesh& mesh, Pieces& pieces) noexcept {
  if (!(mesh.thin > 0.0)) return;
  const auto is_noise = [&](const Piece& piece) { return is_thin(mesh.corners(piece.triangle), mesh.thin); };
  const auto begin = pieces.all.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(pieces.count);
  if (std::all_of(begin, end, is_noise)) return;
  pieces.count = static_cast<std::size_t>(std::remove_if(begin, end, is_noise) - begin);
}

}  // namespace

bool add_piece_above(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, const Vec3& up,
                     double most, Limit& limit, Pieces& pieces) noexcept {
  const auto above = surface_above(mesh, body_in_mesh, body, body.farthest(-up), up, most, limit);
  if (!above || pieces.count == pieces.all.size()) return false;
  const auto end = pieces.all.begin() + static_cast<std::ptrdiff_t>(pieces.count);
  const auto is_it = [&](const Piece& piece) { return piece.triangle == above->triangle; };
  if (std::any_of(pieces.all.begin(), end, is_it)) return false;
  Piece& piece = pieces.all[pieces.count];
  if (!cut_triangle(mesh, above->triangle, body_in_mesh.inverse(), body, all_sides, piece)) return false;
  ++pieces.count;
  return true;
}

void gather_pieces(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, std::uint32_t turn,
                   Limit& limit, Pieces& pieces) noexcept {
  constexpr std::uint64_t from_all_octants = 8 * Pieces::most;  // nodes: some for each piece that there is room for
  if (has_many_sides(body) && limit.nodes_in_time(time_for_pieces) < from_all_octants) {
    gather_from_within(mesh, body_in_mesh, body, turn, limit, pieces);
  } else {
    Gathering(mesh, body_in_mesh, body, turn, limit, pieces).run();
  }
  leave_out_thin(mesh, pieces);
}

}  // namespace odds::ode
