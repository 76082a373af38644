// Eight pairs of a patch at a time: on every instruction set the same bits, and what one pair at a time gives.
#include "query/patch/eight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"
#include "query/wide/searches.hpp"
#include "support/instruction_sets.hpp"

namespace odds::query::patch {
namespace {

constexpr double rounding = 1e-12;  // of a scene about 1 m wide

/// Triangles of all kinds: many, some without area, some in planes of round coordinates, some that share corners.
struct Scene {
  std::vector<Vec3> vertices_a;
  std::vector<Vec3> vertices_b;
  std::vector<mesh::Triangle> triangles;
  std::vector<TrianglePair> hits;
  PatchInput input;

  explicit Scene(std::uint64_t stream) {
    math::Random random(31, stream);
    const bool round = stream % 3 == 0;
    const auto corner = [&] {
      const auto at = [&] { return round ? 0.25 * static_cast<double>(random.below(4)) : random.uniform(); };
      return Vec3(at(), at(), at());
    };
    constexpr std::uint32_t count = 12;
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
      vertices_a.push_back(corner());
      vertices_b.push_back(corner());
    }
    for (std::uint32_t i = 0; i < count; ++i) triangles.push_back({3 * i, 3 * i + 1, 3 * i + (i == 5 ? 1 : 2)});
    for (std::uint32_t i = 0; i < count; ++i) hits.push_back({i, static_cast<std::uint32_t>(random.below(count))});
    if (!round) input.pose_b_in_a.rotation = random.rotation().toRotationMatrix();
    if (!round) input.pose_b_in_a.translation = 0.2 * random.direction();
    input.hits = hits;
    input.vertices_a = vertices_a;
    input.vertices_b = vertices_b;
    input.triangles_a = input.triangles_b = triangles;
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  [[nodiscard]] std::vector<PlacedPair> placed(const Kernels& kernels) const {
    std::vector<PlacedPair> pairs(hits.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < hits.size(); i += eight) {
      const std::size_t asked = std::min(eight, hits.size() - i);
      count += kernels.place(input, std::span(hits).subspan(i, asked), pairs.data() + count);
    }
    pairs.resize(count);
    return pairs;
  }
};

Vec3 unit_normal(const std::array<Vec3, 3>& t) {
  const Vec3 cross = (t[1] - t[0]).cross(t[2] - t[0]);
  const double longest =
      std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm()});
  return cross.norm() > tolerances::degenerate_triangle * longest ? Vec3(cross.normalized()) : Vec3(Vec3::Zero());
}

/// One pair, by Eigen.
PlacedPair place(const PatchInput& input, const TrianglePair& index) {
  PlacedPair placed;
  for (std::size_t k = 0; k < 3; ++k) {
    placed.a[k] = input.vertices_a[input.triangles_a[index.a][k]];
    placed.b[k] = input.pose_b_in_a * input.vertices_b[input.triangles_b[index.b][k]];
  }
  placed.normal_a = unit_normal(placed.a);
  placed.normal_b = unit_normal(placed.b);
  placed.index = index;
  return placed;
}

std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> all;
  for (const InstructionSet set : testing::instruction_sets) {
    if (const wide::Searches* searches = wide::searches_for(set)) all.push_back(&searches->patch);
  }
  return all;
}

template <class T>
bool same_bits(const T& x, const T& y) {
  return std::memcmp(&x, &y, sizeof(T)) == 0;
}

TEST(PatchEight, PlacesAsOneAtATime) {
  for (const Kernels* kernels : all_kernels()) {
    for (std::uint64_t stream = 0; stream < 300; ++stream) {
      const Scene scene(stream);
      const std::vector<PlacedPair> pairs = scene.placed(*kernels);
      ASSERT_EQ(pairs.size(), scene.hits.size());
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const PlacedPair one = place(scene.input, scene.hits[i]);
        EXPECT_EQ(pairs[i].index.a, one.index.a);
        EXPECT_EQ(pairs[i].index.b, one.index.b);
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_EQ(pairs[i].a[k], one.a[k]);
          EXPECT_LE((pairs[i].b[k] - one.b[k]).norm(), rounding);
        }
        EXPECT_EQ(pairs[i].normal_a.isZero(0.0), one.normal_a.isZero(0.0));
        EXPECT_EQ(pairs[i].normal_b.isZero(0.0), one.normal_b.isZero(0.0));
        EXPECT_LE((pairs[i].normal_a - one.normal_a).norm(), 1e-9);
        EXPECT_LE((pairs[i].normal_b - one.normal_b).norm(), 1e-9);
      }
    }
  }
}

TEST(PatchEight, LeavesOutWhatIsNotFiniteInAnyCoordinate) {
  for (const Kernels* kernels : all_kernels()) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (const bool of_a : {true, false}) {
          Scene scene(0);  // its pose is no turn, which would spread it over all axes
          (of_a ? scene.vertices_a : scene.vertices_b)[7][axis] = bad;
          scene.hits = {{0, 0}, {2, 2}, {3, 3}};
          scene.input.hits = scene.hits;
          const std::vector<PlacedPair> pairs = scene.placed(*kernels);
          ASSERT_EQ(pairs.size(), 2U) << axis << of_a;
          EXPECT_EQ(pairs[1].index.a, 3U);
        }
      }
    }
  }
}

TEST(PatchEight, LeavesOutWhatIsOutOfRangeOrNotFinite) {
  for (const Kernels* kernels : all_kernels()) {
    Scene scene(1);
    scene.vertices_a[3] = Vec3(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
    scene.vertices_b[7] = Vec3(0.0, 0.0, -std::numeric_limits<double>::infinity());
    scene.triangles[4][2] = 36;
    scene.hits = {{0, 0}, {1, 0}, {0, 2}, {3, 3}, {4, 0}, {0, 4}, {12, 0}, {0, 12}, {6, 7}};
    scene.input.hits = scene.hits;
    const std::vector<PlacedPair> pairs = scene.placed(*kernels);
    ASSERT_EQ(pairs.size(), 3U);
    EXPECT_EQ(pairs[1].index.a, 3U);
    EXPECT_EQ(pairs[1].a[0], scene.vertices_a[9]);
    EXPECT_EQ(pairs[2].index.b, 7U);
    EXPECT_EQ(pairs[2].a[1], scene.vertices_a[19]);
  }
}

TEST(PatchEight, CutsAsOneAtATime) {
  std::size_t plain = 0;
  std::size_t others = 0;
  for (const Kernels* kernels : all_kernels()) {
    for (std::uint64_t stream = 0; stream < 300; ++stream) {
      const Scene scene(stream);
      const std::vector<PlacedPair> pairs = scene.placed(*kernels);
      CutEight cut;
      for (std::size_t first = 0; first < pairs.size(); first += eight) {
        const std::size_t count = std::min(eight, pairs.size() - first);
        kernels->cut(&pairs[first], count, cut);
        EXPECT_EQ(cut.plain >> count, 0U);
        for (std::size_t lane = 0; lane < count; ++lane) {
          if ((cut.plain >> lane & 1U) == 0) {
            ++others;
            continue;
          }
          ++plain;
          std::array<RimPiece, most_pieces_of_a_pair> one;
          ASSERT_EQ(rim_pieces(pairs[first + lane], false, 7, one), 1U);
          const RimPiece piece = cut.piece(lane, 7);
          EXPECT_LE((piece.from - one[0].from).norm(), 1e-9);
          EXPECT_LE((piece.to - one[0].to).norm(), 1e-9);
          EXPECT_NEAR(piece.length, one[0].length, 1e-9);
          EXPECT_NEAR(piece.length, piece.along().norm(), rounding);
          EXPECT_EQ(piece.pair, 7U);
        }
      }
    }
  }
  EXPECT_GT(plain, 500U);
  EXPECT_GT(others, 500U);  // those that need care
}

TEST(PatchEight, FindsTheCornersThatOneAtATimeFinds) {
  std::size_t seen = 0;
  for (const Kernels* kernels : all_kernels()) {
    for (std::uint64_t stream = 0; stream < 300; ++stream) {
      const Scene scene(stream);
      math::Random random(32, stream);
      const Frame frame(random.direction());
      const std::vector<PlacedPair> pairs = scene.placed(*kernels);
      std::vector<const PlacedPair*> asked;
      for (std::size_t i = 0; i < std::min(eight, pairs.size()); ++i) asked.push_back(&pairs[i]);
      CornersOfEight corners;
      kernels->corners(asked, frame, Vec3::Zero(), 0.0, corners);
      const auto kinds = corners.kinds_of_lanes();
      for (std::size_t lane = 0; lane < asked.size(); ++lane) {
        std::vector<Witness> expected;
        overlap_corners(*asked[lane], frame, Vec3::Zero(), [&](const Vec3& on_a, const Vec3& on_b, double depth) {
          if (depth >= 0.0) expected.push_back({on_a, on_b, depth, asked[lane]->index.a, asked[lane]->index.b});
        });
        std::vector<Witness> found;
        for (std::size_t kind = 0; kind < CornersOfEight::kinds; ++kind) {
          if ((kinds[lane] >> kind & 1U) != 0) found.push_back(corners.witness(*asked[lane], frame.normal, kind, lane));
        }
        if (stream % 3 == 0) continue;  // of round coordinates much is on a border, and either is right
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i, ++seen) {
          EXPECT_LE((found[i].on_a - expected[i].on_a).norm(), 1e-9);
          EXPECT_LE((found[i].on_b - expected[i].on_b).norm(), 1e-9);
          EXPECT_NEAR(found[i].depth, expected[i].depth, 1e-9);
          EXPECT_EQ(found[i].triangle_a, expected[i].triangle_a);
          EXPECT_EQ(found[i].triangle_b, expected[i].triangle_b);
        }
      }
    }
  }
  EXPECT_GT(seen, 500U);
}

TEST(PatchEight, MeasuresTheDepthsThatOneAtATimeMeasures) {
  const Vec3 shift(0.01, 0.0, 0.02);
  const Kernels& kernels = wide::searches_for(InstructionSet::best)->patch;
  std::size_t deep = 0;
  for (std::uint64_t stream = 1; stream < 3000; stream += 3) {
    const Scene scene(stream);
    const Frame frame(math::Random(34, stream).direction());
    const std::vector<PlacedPair> pairs = scene.placed(kernels);
    ASSERT_GE(pairs.size(), eight);
    std::vector<const PlacedPair*> asked;
    for (std::size_t i = 0; i < stream % eight + 1; ++i) asked.push_back(&pairs[i]);
    CornersOfEight corners;
    kernels.corners(asked, frame, shift, 0.0, corners);
    for (std::size_t lane = 0; lane < eight; ++lane) {
      const double expected = pair_depth(*asked[lane < asked.size() ? lane : 0], frame, shift);
      EXPECT_NEAR(corners.deepest[lane], expected, 1e-9) << "stream " << stream << ", lane " << lane;
      deep += expected > 0.0 ? 1U : 0U;
    }
  }
  EXPECT_GT(deep, 100U);
}

TEST(PatchEight, KeepsTheFarthestOfAFanAndOfEquallyFarOnesTheFirst) {
  const Fan fan;
  math::Random random(33);
  std::vector<double> u;
  std::vector<double> v;
  for (int i = 0; i < 40; ++i) {
    u.push_back(random.uniform(-1.0, 1.0));
    v.push_back(random.uniform(-1.0, 1.0));
  }
  u.insert(u.end(), u.begin(), u.begin() + 20);  // once more
  v.insert(v.end(), v.begin(), v.begin() + 20);
  for (const Kernels* kernels : all_kernels()) {
    FanEnds ends;
    kernels->farthest(u.data(), v.data(), 25, 0, fan, ends);
    kernels->farthest(u.data() + 25, v.data() + 25, 35, 25, fan, ends);
    for (std::size_t d = 0; d < Fan::size; ++d) {
      std::size_t best = 0;
      const auto far = [&](std::size_t i) { return fan.u[d] * u[i] + fan.v[d] * v[i]; };
      for (std::size_t i = 1; i < u.size(); ++i) best = far(i) > far(best) ? i : best;
      EXPECT_EQ(ends.end(d), best);
    }
  }
}

/// Faces that are one with a direction, others, and steep ones.
struct Faces {
  std::vector<PlacedPair> pairs;
  EightPieces eight;

  Faces(std::uint64_t stream, std::size_t count) : pairs(count) {
    math::Random random(34, stream);
    for (PlacedPair& pair : pairs) {
      const double off = random.below(2) == 0 ? 0.003 : 0.6;
      pair.normal_b = (Vec3::UnitZ() + off * random.direction()).normalized();
      pair.normal_a = (random.below(2) == 0 ? -1.0 : 1.0) * (Vec3::UnitZ() + off * random.direction()).normalized();
      RimPiece piece;
      piece.length = random.uniform(0.1, 1.0);
      eight.add(piece, pair);
    }
  }
};

TEST(PatchEight, AddsUpTheFacesThatAgree) {
  for (const Kernels* kernels : all_kernels()) {
    for (std::uint64_t stream = 0; stream < 80; ++stream) {
      const Faces faces(stream, 1 + stream % eight);
      const Facing facing{Vec3::UnitZ(), stream % 2 == 0, stream % 3 == 0};
      FaceSums sums;
      const unsigned others = kernels->same_faces(faces.eight, facing, Vec3::UnitZ(), sums);
      Vec3 normals = Vec3::Zero();
      double lengths = 0.0;
      unsigned expected = 0;
      for (std::size_t i = 0; i < faces.pairs.size(); ++i) {
        const Vec3 both[] = {facing.of_b(faces.pairs[i]), facing.of_a(faces.pairs[i])};
        for (std::size_t side = 0; side < 2; ++side) {
          if (both[side].z() > tolerances::same_face) {
            normals += faces.eight.length[i] * both[side];
            lengths += faces.eight.length[i];
          } else if (both[side] != Vec3::Zero()) {
            expected |= 1U << (i + 8 * side);
          }
        }
      }
      EXPECT_EQ(others, expected);
      EXPECT_LE((sums.normals() - normals).norm(), rounding);
      EXPECT_NEAR(sums.lengths(), lengths, rounding);
    }
  }
}

TEST(PatchEight, AddsUpWhatIsAsGoodAsFlatAndLeavesWhatIsNotClear) {
  std::size_t unclear = 0;
  for (const Kernels* kernels : all_kernels()) {
    for (std::uint64_t stream = 0; stream < 80; ++stream) {
      const Faces faces(stream, 1 + stream % eight);
      const Facing facing{Vec3::UnitZ(), stream % 2 == 0, stream % 3 == 0};
      const Vec3 flat = Vec3(0.005, 0.0, 1.0).normalized();
      FaceSums sums;
      const unsigned left = kernels->flat_faces(faces.eight, facing, flat, sums);
      Vec3 normals = Vec3::Zero();
      double lengths = 0.0;
      for (std::size_t i = 0; i < faces.pairs.size(); ++i) {
        if ((left >> i & 1U) != 0) {
          ++unclear;
          continue;
        }
        double counts = 0.0;
        for (const Vec3& face : {facing.of_b(faces.pairs[i]), facing.of_a(faces.pairs[i])}) {
          EXPECT_FALSE(face.dot(flat) > not_flat && face.dot(flat) < flat_agreement);
          if (!(face.dot(flat) > flat_agreement)) continue;
          normals += faces.eight.length[i] * face;
          counts = faces.eight.length[i];
        }
        lengths += counts;
      }
      EXPECT_LE((sums.normals() - normals).norm(), rounding);
      EXPECT_NEAR(sums.lengths(), lengths, rounding);
    }
  }
  EXPECT_GT(unclear, 10U);
}

TEST(PatchEight, GivesTheSameBitsOnAllInstructionSets) {
  const std::vector<const Kernels*> all = all_kernels();
  ASSERT_GE(all.size(), 1U);
  for (std::uint64_t stream = 0; stream < 300; ++stream) {
    const Scene scene(stream);
    const Frame frame(math::Random(35, stream).direction());
    const std::vector<PlacedPair> pairs = scene.placed(*all[0]);
    ASSERT_GE(pairs.size(), eight);
    std::vector<const PlacedPair*> asked;
    for (std::size_t i = 0; i < eight; ++i) asked.push_back(&pairs[i]);
    CutEight cut;
    CornersOfEight corners{};
    all[0]->cut(pairs.data(), eight, cut);
    all[0]->corners(asked, frame, Vec3(0.01, 0.0, 0.02), 0.0, corners);
    for (std::size_t k = 1; k < all.size(); ++k) {
      const std::vector<PlacedPair> others = scene.placed(*all[k]);
      ASSERT_EQ(others.size(), pairs.size());
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_TRUE(same_bits(others[i].b, pairs[i].b));
        EXPECT_TRUE(same_bits(others[i].normal_a, pairs[i].normal_a));
        EXPECT_TRUE(same_bits(others[i].normal_b, pairs[i].normal_b));
      }
      CutEight other_cut;
      CornersOfEight other_corners{};
      all[k]->cut(pairs.data(), eight, other_cut);
      all[k]->corners(asked, frame, Vec3(0.01, 0.0, 0.02), 0.0, other_corners);
      EXPECT_EQ(other_cut.plain, cut.plain);
      EXPECT_EQ(other_corners.found, corners.found);
      for (std::size_t lane = 0; lane < eight; ++lane) {
        if ((cut.plain >> lane & 1U) != 0) {
          EXPECT_TRUE(same_bits(other_cut.piece(lane, 0).from, cut.piece(lane, 0).from));
          EXPECT_TRUE(same_bits(other_cut.piece(lane, 0).to, cut.piece(lane, 0).to));
          EXPECT_TRUE(same_bits(other_cut.length[lane], cut.length[lane]));
        }
        for (std::size_t kind = 0; kind < CornersOfEight::kinds; ++kind) {
          if ((corners.found[kind] >> lane & 1U) == 0) continue;
          EXPECT_TRUE(same_bits(other_corners.depth[kind][lane], corners.depth[kind][lane]));
          if (kind >= CornersOfEight::crossing) {
            EXPECT_TRUE(same_bits(other_corners.share[kind][lane], corners.share[kind][lane]));
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace odds::query::patch
