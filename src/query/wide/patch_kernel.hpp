// Contacts, eight triangle pairs at a time: corners and normals, pieces of rim, corners of overlaps.
#pragma once

#include <bit>
#include <limits>

#include "odds/math/tolerances.hpp"
#include "query/patch/eight.hpp"
#include "query/wide/doubles.hpp"

namespace odds::query::wide {

/// The functions of patch/rim.hpp and patch/overlap.hpp in other words: without branches, and where one of eight needs
/// care, that one is left to them.
template <class L>
class PatchKernel {
 public:
  static constexpr patch::Kernels table() noexcept {
    return {&place, &cut, &corners, &corners_along, &same_faces, &flat_faces, &farthest};
  }

 private:
  using R = typename lanes::DoublesOf<L>::Register;
  using D = lanes::Doubles<R>;
  using P = lanes::Points<R>;
  using T = lanes::Truths<R>;
  using Triangle = P[3];

  /// Numbers of eight pairs, to be written one pair after the other.
  struct alignas(64) ByLane {
    double of[15][patch::eight];
  };

  static std::size_t place(const PatchInput& input, std::span<const TrianglePair> hits,
                           patch::PlacedPair* placed) noexcept {
    const double* a[3][patch::eight];
    const double* b[3][patch::eight];
    std::size_t count = 0;
    for (const TrianglePair& hit : hits) {
      if (hit.a >= input.triangles_a.size() || hit.b >= input.triangles_b.size()) continue;
      const std::uint32_t* const corners_a = input.triangles_a.data()[hit.a].data();
      const std::uint32_t* const corners_b = input.triangles_b.data()[hit.b].data();
      bool in_range = true;
      for (int k = 0; k < 3; ++k) {
        in_range = in_range && corners_a[k] < input.vertices_a.size() && corners_b[k] < input.vertices_b.size();
      }
      if (!in_range) continue;
      for (int k = 0; k < 3; ++k) {
        a[k][count] = input.vertices_a.data()[corners_a[k]].data();
        b[k][count] = input.vertices_b.data()[corners_b[k]].data();
      }
      placed[count++].index = hit;
    }
    if (count == 0) return 0;
    for (std::size_t lane = count; lane < patch::eight; ++lane) {
      for (int k = 0; k < 3; ++k) {
        a[k][lane] = a[k][0];
        b[k][lane] = b[k][0];
      }
    }
    ByLane numbers;
    const unsigned finite = place_corners(input, a, b, numbers);
    std::size_t kept = 0;
    for (std::size_t lane = 0; lane < count; ++lane) {
      if ((finite >> lane & 1U) == 0) continue;
      patch::PlacedPair& pair = placed[kept];
      pair.index = placed[lane].index;
      ++kept;
      for (int k = 0; k < 3; ++k) {
        double* const corner = pair.a.data()[k].data();
        for (int i = 0; i < 3; ++i) corner[i] = a[k][lane][i];
        write(numbers, 3 * k, lane, pair.b.data()[k].data());
      }
      write(numbers, 9, lane, pair.normal_a.data());
      write(numbers, 12, lane, pair.normal_b.data());
    }
    return kept;
  }

  ODDS_LANES_INLINE static void write(const ByLane& numbers, int first, std::size_t lane, double* to) noexcept {
    for (int i = 0; i < 3; ++i) to[i] = numbers.of[first + i][lane];
  }

  /// Writes B's corners in A's frame and both normals; returns the lanes of which all is finite.
  ODDS_LANES_INLINE static unsigned place_corners(const PatchInput& input, const double* const (&from_a)[3][8],
                                                  const double* const (&from_b)[3][8], ByLane& numbers) noexcept {
    const double* const turn = input.pose_b_in_a.rotation.data();  // by columns
    const P column[3] = {P::all(turn), P::all(turn + 3), P::all(turn + 6)};
    const P shift = P::all(input.pose_b_in_a.translation.data());
    Triangle a;
    Triangle b;
    D nothing = D::all(0.0);  // or no number, if any coordinate is infinite or none
    for (int k = 0; k < 3; ++k) {
      a[k] = P::from(from_a[k]);
      const P own = P::from(from_b[k]);
      b[k] = ((own.x * column[0] + own.y * column[1]) + own.z * column[2]) + shift;
      b[k].store(numbers.of + 3 * k);
      const P zero_a = a[k] - a[k];
      const P zero_b = b[k] - b[k];
      nothing = nothing + ((zero_a.x + zero_a.y) + zero_a.z) + ((zero_b.x + zero_b.y) + zero_b.z);
    }
    unit_normal(a).store(numbers.of + 9);
    unit_normal(b).store(numbers.of + 12);
    return (nothing <= D::all(0.0)).bits();
  }

  ODDS_LANES_INLINE static P unit_normal(const Triangle& t) noexcept {
    const P u = t[1] - t[0];
    const P v = t[2] - t[0];
    const P w = t[2] - t[1];
    const P normal = cross(u, v);
    const D longest = max(max(dot(u, u), dot(v, v)), dot(w, w));
    const D twice_area = root(dot(normal, normal));
    const T has_area = D::all(tolerances::degenerate_triangle) * longest < twice_area;
    const D inverse = D::all(1.0) / choose(has_area, twice_area, D::all(1.0));
    return choose(has_area, inverse * normal, P::all(zeros));
  }

  /// Heights of a triangle's corners above a plane, and whether one of them is alone on its side. One within rounding
  /// of the plane is on neither.
  struct Heights {
    D of[3];
    T alone;

    ODDS_LANES_INLINE Heights(const Triangle& t, const P& normal, const P& origin) noexcept {
      const D zero = D::all(0.0);
      D size = zero;
      D nearest = zero;
      for (int k = 0; k < 3; ++k) {
        const P away = t[k] - origin;
        of[k] = dot(normal, away);
        size = max(size, away.largest());
        nearest = k == 0 ? abs(of[k]) : min(nearest, abs(of[k]));
      }
      const D lowest = min(min(of[0], of[1]), of[2]);
      const D highest = max(max(of[0], of[1]), of[2]);
      alone = (D::all(tolerances::on_plane) * size < nearest) & (lowest < zero) & (zero < highest);
    }
  };

  /// The two points in which a triangle's border meets a plane, the lower one along `direction` first. Precondition:
  /// one corner is alone on its side.
  struct Crossing {
    P low;
    P high;

    ODDS_LANES_INLINE Crossing(const Triangle& t, const Heights& heights, const P& direction) noexcept {
      const D zero = D::all(0.0);
      P point[3];
      T crosses[3];
      for (int k = 0; k < 3; ++k) {
        const int next = k == 2 ? 0 : k + 1;
        const D share = heights.of[k] / (heights.of[k] - heights.of[next]);
        point[k] = t[k] + share * (t[next] - t[k]);
        crosses[k] =
            ((heights.of[k] < zero) & (zero < heights.of[next])) | ((zero < heights.of[k]) & (heights.of[next] < zero));
      }
      const P first = choose(crosses[0], point[0], point[1]);
      const P second = choose(crosses[2], point[2], point[1]);
      const T falls = dot(direction, second - first) < zero;
      low = choose(falls, second, first);
      high = choose(falls, first, second);
    }
  };

  static void cut(const patch::PlacedPair* placed, std::size_t count, patch::CutEight& pieces) noexcept {
    const double* at_a[patch::eight];
    const double* at_b[patch::eight];
    const double* at_normal[2][patch::eight];
    for (std::size_t lane = 0; lane < patch::eight; ++lane) {
      const patch::PlacedPair& pair = placed[lane < count ? lane : 0];
      at_a[lane] = pair.a.data()[0].data();
      at_b[lane] = pair.b.data()[0].data();
      at_normal[0][lane] = pair.normal_a.data();
      at_normal[1][lane] = pair.normal_b.data();
    }
    const Triangle a = {P::from(at_a, 0), P::from(at_a, 1), P::from(at_a, 2)};
    const Triangle b = {P::from(at_b, 0), P::from(at_b, 1), P::from(at_b, 2)};
    const P normal_a = P::from(at_normal[0]);
    const P normal_b = P::from(at_normal[1]);
    const P direction = cross(normal_b, normal_a);
    const D zero = D::all(0.0);
    const Heights heights_a(a, normal_b, b[0]);
    const Heights heights_b(b, normal_a, a[0]);
    const T plain = (D::all(tolerances::parallel_planes * tolerances::parallel_planes) < dot(direction, direction)) &
                    heights_a.alone & heights_b.alone;
    const Crossing of_a(a, heights_a, direction);
    const Crossing of_b(b, heights_b, direction);
    P from = choose(zero < dot(direction, of_b.low - of_a.low), of_b.low, of_a.low);
    P to = choose(dot(direction, of_b.high - of_a.high) < zero, of_b.high, of_a.high);
    const T emptied = dot(direction, to - from) < zero;
    const P middle = D::all(0.5) * (from + to);
    from = choose(emptied, middle, from);
    to = choose(emptied, middle, to);
    const P along = to - from;
    const D length = root(dot(along, along));
    from.store(pieces.from);
    to.store(pieces.to);
    length.store(pieces.length);
    const T finite = length <= D::all(std::numeric_limits<double>::max());
    pieces.plain = (plain & finite).bits() & ((1U << count) - 1U);
  }

  ODDS_LANES_INLINE static D flat_cross(const P& p, const P& q) noexcept { return p.x * q.y - p.y * q.x; }

  /// In the frame: x and y across the normal, z along it.
  ODDS_LANES_INLINE static P in_frame(const P (&axes)[3], const P& p) noexcept {
    return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
  }

  /// Heights of the face above each corner, and which corners are over it at all.
  ODDS_LANES_INLINE static void corners_over(const Triangle& corners, const Triangle& face, const P& normal,
                                             const P& up, D (&height)[3], T (&over)[3]) noexcept {
    const D area = flat_cross(face[1] - face[0], face[2] - face[0]);
    const D zero = D::all(0.0);
    const T faces = (D::all(tolerances::edge_on) <= abs(dot(normal, up))) & (zero < abs(area));
    const D inverse = D::all(1.0) / choose(faces, area, D::all(1.0));
    const D least = D::all(-tolerances::on_border);
    for (int k = 0; k < 3; ++k) {
      const D w0 = flat_cross(face[1] - corners[k], face[2] - corners[k]) * inverse;
      const D w1 = flat_cross(face[2] - corners[k], face[0] - corners[k]) * inverse;
      const D w2 = (D::all(1.0) - w0) - w1;
      height[k] = (w0 * face[0].z + w1 * face[1].z) + w2 * face[2].z;
      over[k] = faces & (least <= min(min(w0, w1), w2));
    }
  }

  static void corners(std::span<const patch::PlacedPair* const> pairs, const patch::Frame& frame, const Vec3& shift,
                      double least_depth, patch::CornersOfEight& found) noexcept {
    const double* at_a[patch::eight];
    const double* at_b[patch::eight];
    const double* at_normal[2][patch::eight];
    for (std::size_t lane = 0; lane < patch::eight; ++lane) {
      const patch::PlacedPair& pair = *pairs.data()[lane < pairs.size() ? lane : 0];
      at_a[lane] = pair.a.data()[0].data();
      at_b[lane] = pair.b.data()[0].data();
      at_normal[0][lane] = pair.normal_a.data();
      at_normal[1][lane] = pair.normal_b.data();
    }
    const Sight sight{{P::all(frame.u.data()), P::all(frame.v.data()), P::all(frame.normal.data())},
                      P::from(at_normal[0]),
                      P::from(at_normal[1])};
    const Triangle a = {P::from(at_a, 0), P::from(at_a, 1), P::from(at_a, 2)};
    const Triangle b = {P::from(at_b, 0), P::from(at_b, 1), P::from(at_b, 2)};
    find_corners(a, b, sight, P::all(shift.data()), Wanted{D::all(least_depth), (1U << pairs.size()) - 1U}, found);
  }

  static void corners_along(const patch::PlacedPair& pair, std::span<const Vec3> directions, const Vec3& shift,
                            patch::CornersOfEight& found) noexcept {
    const double* at[patch::eight];
    for (std::size_t lane = 0; lane < patch::eight; ++lane) {
      at[lane] = directions.data()[lane < directions.size() ? lane : 0].data();
    }
    const Sight sight(P::from(at), P::all(pair.normal_a.data()), P::all(pair.normal_b.data()));
    const Triangle a = {P::all(pair.a.data()[0].data()), P::all(pair.a.data()[1].data()),
                        P::all(pair.a.data()[2].data())};
    const Triangle b = {P::all(pair.b.data()[0].data()), P::all(pair.b.data()[1].data()),
                        P::all(pair.b.data()[2].data())};
    find_corners(a, b, sight, P::all(shift.data()), Wanted{D::all(0.0), (1U << directions.size()) - 1U}, found);
  }

  static constexpr double zeros[3] = {0.0, 0.0, 0.0};

  /// The axes of patch::Frame, and both triangles' normals.
  struct Sight {
    P axes[3];
    P normal_a;
    P normal_b;

    ODDS_LANES_INLINE Sight(const P (&frame)[3], const P& of_a, const P& of_b) noexcept
        : axes{frame[0], frame[1], frame[2]}, normal_a(of_a), normal_b(of_b) {}
    ODDS_LANES_INLINE Sight(const P& up, const P& of_a, const P& of_b) noexcept
        : axes{P::all(zeros), P::all(zeros), up}, normal_a(of_a), normal_b(of_b) {
      const D one = D::all(1.0);
      const D zero = D::all(0.0);
      const D sign = choose(up.z < zero, D::all(-1.0), one);
      const D p = D::all(-1.0) / (sign + up.z);
      const D q = (up.x * up.y) * p;
      axes[0] = {one + ((sign * up.x) * up.x) * p, sign * q, (zero - sign) * up.x};
      axes[1] = {q, sign + (up.y * up.y) * p, zero - up.y};
    }
  };

  struct Wanted {
    D least_depth;
    unsigned lanes;
  };

  ODDS_LANES_INLINE static void find_corners(const Triangle& at_a, const Triangle& at_b, const Sight& sight,
                                             const P& shift, const Wanted& wanted,
                                             patch::CornersOfEight& found) noexcept {
    const P& origin = at_b[0];
    const Triangle a = {in_frame(sight.axes, (at_a[0] + shift) - origin),
                        in_frame(sight.axes, (at_a[1] + shift) - origin),
                        in_frame(sight.axes, (at_a[2] + shift) - origin)};
    const Triangle b = {P::all(zeros), in_frame(sight.axes, at_b[1] - origin), in_frame(sight.axes, at_b[2] - origin)};
    D height[3];
    T over[3];
    D deepest = D::all(0.0);
    corners_over(a, b, sight.normal_b, sight.axes[2], height, over);
    for (std::size_t k = 0; k < 3; ++k) {
      keep(wanted, patch::CornersOfEight::of_a + k, height[k] - a[k].z, over[k], deepest, found);
    }
    corners_over(b, a, sight.normal_a, sight.axes[2], height, over);
    for (std::size_t k = 0; k < 3; ++k) {
      keep(wanted, patch::CornersOfEight::of_b + k, b[k].z - height[k], over[k], deepest, found);
    }
    cross_sides(a, b, wanted, deepest, found);
    deepest.store(found.deepest);
  }

  ODDS_LANES_INLINE static void keep(const Wanted& wanted, std::size_t kind, const D& depth, const T& is_there,
                                     D& deepest, patch::CornersOfEight& corners) noexcept {
    depth.store(corners.depth[kind]);
    const T deep = is_there & (wanted.least_depth <= depth) & (depth <= D::all(std::numeric_limits<double>::max()));
    deepest = max(deepest, choose(deep, depth, deepest));
    corners.found.data()[kind] = static_cast<std::uint8_t>(deep.bits() & wanted.lanes);
  }

  /// A side of a triangle as seen along the normal.
  struct Side {
    P along;
    D seen;     ///< square of the length across the normal
    T is_seen;  ///< it does not run along the line of sight

    ODDS_LANES_INLINE Side(const P& from, const P& to) noexcept
        : along(to - from),
          seen(along.x * along.x + along.y * along.y),
          is_seen(D::all(tolerances::edge_on * tolerances::edge_on) * (seen + along.z * along.z) < seen) {}
  };

  ODDS_LANES_INLINE static void cross_sides(const Triangle& a, const Triangle& b, const Wanted& wanted, D& deepest,
                                            patch::CornersOfEight& found) noexcept {
    const Side sides_a[3] = {{a[0], a[1]}, {a[1], a[2]}, {a[2], a[0]}};
    const Side sides_b[3] = {{b[0], b[1]}, {b[1], b[2]}, {b[2], b[0]}};
    const D low = D::all(-tolerances::on_border);
    const D high = D::all(1.0 + tolerances::on_border);
    const D parallel = D::all(tolerances::parallel_sides * tolerances::parallel_sides);
    for (std::size_t i = 0; i < 3; ++i) {
      const Side& side_a = sides_a[i];
      for (std::size_t j = 0; j < 3; ++j) {
        const Side& side_b = sides_b[j];
        const D denominator = flat_cross(side_a.along, side_b.along);
        const T crosses =
            side_a.is_seen & side_b.is_seen & (parallel * side_a.seen * side_b.seen < denominator * denominator);
        const D inverse = D::all(1.0) / choose(crosses, denominator, D::all(1.0));
        const P between = b[j] - a[i];
        const D s = flat_cross(between, side_b.along) * inverse;
        const D t = flat_cross(between, side_a.along) * inverse;
        const T within = crosses & (low <= min(s, t)) & (max(s, t) <= high);
        const D depth = (b[j].z + t * side_b.along.z) - (a[i].z + s * side_a.along.z);
        const std::size_t kind = patch::CornersOfEight::crossing + 3 * i + j;
        s.store(found.share[kind]);
        keep(wanted, kind, depth, within, deepest, found);
      }
    }
  }

  /// One body's normals of eight pairs, turned to face a direction. Those that may not are turned by 0.
  struct Faces {
    P normal;
    D turned;

    ODDS_LANES_INLINE Faces(const double* const (&at)[8], const Vec3& direction, bool solid, double sign) noexcept
        : normal(P::from(at)) {
      const D zero = D::all(0.0);
      const D one = D::all(1.0);
      const D along = dot(normal, P::all(direction.data()));
      const T allowed = D::all(solid ? 0.0 : -2.0) <= D::all(sign) * along;
      const T faces = (D::all(patch::Facing::steepest) < abs(along)) & allowed;
      turned = choose(faces, choose(along < zero, D::all(-1.0), one), zero);
    }
    [[nodiscard]] ODDS_LANES_INLINE D agreement(const Vec3& direction) const noexcept {
      return turned * dot(normal, P::all(direction.data()));
    }
  };
  struct BothFaces {
    Faces b;
    Faces a;

    ODDS_LANES_INLINE BothFaces(const patch::EightPieces& pieces, const patch::Facing& facing) noexcept
        : BothFaces(Normals(pieces), facing) {}

   private:
    struct Normals {
      const double* of_a[patch::eight];
      const double* of_b[patch::eight];
      ODDS_LANES_INLINE explicit Normals(const patch::EightPieces& pieces) noexcept {
        for (std::size_t lane = 0; lane < patch::eight; ++lane) {
          const patch::PlacedPair* const pair = pieces.pairs.data()[lane < pieces.count ? lane : 0];
          of_a[lane] = pair->normal_a.data();
          of_b[lane] = pair->normal_b.data();
        }
      }
    };
    ODDS_LANES_INLINE BothFaces(const Normals& normals, const patch::Facing& facing) noexcept
        : b(normals.of_b, facing.direction, facing.solid_b, 1.0),
          a(normals.of_a, facing.direction, facing.solid_a, -1.0) {}
  };

  ODDS_LANES_INLINE static void add_to(double (&sums)[patch::eight], const D& more) noexcept {
    (D::load(sums) + more).store(sums);
  }
  ODDS_LANES_INLINE static void add_to(double (&sums)[3][patch::eight], const P& more) noexcept {
    add_to(sums[0], more.x);
    add_to(sums[1], more.y);
    add_to(sums[2], more.z);
  }

  static unsigned same_faces(const patch::EightPieces& pieces, const patch::Facing& facing, const Vec3& first,
                             patch::FaceSums& sums) noexcept {
    const BothFaces faces(pieces, facing);
    const D zero = D::all(0.0);
    const D length = D::load(pieces.length.data());
    const unsigned used = (1U << pieces.count) - 1U;
    const D least = D::all(tolerances::same_face);
    const T same_b = least < faces.b.agreement(first);
    const T same_a = least < faces.a.agreement(first);
    const D by_b = choose(same_b, length, zero);
    const D by_a = choose(same_a, length, zero);
    add_to(sums.normal, (by_b * faces.b.turned) * faces.b.normal + (by_a * faces.a.turned) * faces.a.normal);
    add_to(sums.length, by_b + by_a);
    const unsigned others_b = (zero < abs(faces.b.turned)).bits() & ~same_b.bits() & used;
    const unsigned others_a = (zero < abs(faces.a.turned)).bits() & ~same_a.bits() & used;
    return others_b | others_a << 8U;
  }

  static unsigned flat_faces(const patch::EightPieces& pieces, const patch::Facing& facing, const Vec3& flat,
                             patch::FaceSums& sums) noexcept {
    const BothFaces faces(pieces, facing);
    const D zero = D::all(0.0);
    const D length = D::load(pieces.length.data());
    const D enough = D::all(patch::flat_agreement);
    const D far_off = D::all(patch::not_flat);
    const D agreement_b = faces.b.agreement(flat);
    const D agreement_a = faces.a.agreement(flat);
    const T flat_b = enough < agreement_b;
    const T flat_a = enough < agreement_a;
    const unsigned unclear = ((far_off <= abs(agreement_b)).bits() & ~flat_b.bits()) |
                             ((far_off <= abs(agreement_a)).bits() & ~flat_a.bits());
    alignas(64) double clear[patch::eight];
    for (unsigned lane = 0; lane < patch::eight; ++lane) clear[lane] = (unclear >> lane & 1U) != 0 ? 0.0 : 1.0;
    const D counted = unclear != 0 ? D::load(clear) * length : length;
    const D by_b = choose(flat_b, counted, zero);
    const D by_a = choose(flat_a, counted, zero);
    add_to(sums.normal, (by_b * faces.b.turned) * faces.b.normal + (by_a * faces.a.turned) * faces.a.normal);
    add_to(sums.length, max(by_b, by_a));
    return unclear & ((1U << pieces.count) - 1U);
  }

  static void farthest(const double* u, const double* v, std::size_t count, std::size_t first, const patch::Fan& fan,
                       patch::FanEnds& ends) noexcept {
    static_assert(patch::Fan::size == 16);
    const D fan_u[2] = {D::load(fan.u.data()), D::load(fan.u.data() + 8)};
    const D fan_v[2] = {D::load(fan.v.data()), D::load(fan.v.data() + 8)};
    D far[2] = {D::load(ends.far.data()), D::load(ends.far.data() + 8)};
    D at[2] = {D::load(ends.at.data()), D::load(ends.at.data() + 8)};
    for (std::size_t i = 0; i < count; ++i) {
      const D number = D::all(static_cast<double>(first + i));
      for (int half = 0; half < 2; ++half) {
        const D here = fan_u[half] * D::all(u[i]) + fan_v[half] * D::all(v[i]);
        const T farther = far[half] < here;
        far[half] = choose(farther, here, far[half]);
        at[half] = choose(farther, number, at[half]);
      }
    }
    for (int half = 0; half < 2; ++half) {
      far[half].store(ends.far.data() + 8 * half);
      at[half].store(ends.at.data() + 8 * half);
    }
  }
};

}  // namespace odds::query::wide
