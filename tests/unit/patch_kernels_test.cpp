// Contacts are made with the kernels of the instruction set that a pair runs on.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <span>
#include <vector>

#include "odds/query/pair.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/patch/eight.hpp"
#include "query/wide/searches.hpp"
#include "support/contact_scene.hpp"
#include "support/flush_slabs.hpp"
#include "support/instruction_sets.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

using patch::Kernels;

const Kernels& portable() { return wide::searches_for(InstructionSet::portable)->patch; }

/// How often each of the kernels below was called.
struct Calls {
  int place = 0;
  int cut = 0;
  int corners = 0;
  int corners_along = 0;
  int same_faces = 0;
  int flat_faces = 0;
  int farthest = 0;
} calls;

/// The portable ones, counted.
constexpr Kernels counted = {
    [](const PatchInput& input, std::span<const TrianglePair> hits, patch::PlacedPair* placed) noexcept {
      ++calls.place;
      return portable().place(input, hits, placed);
    },
    [](const patch::PlacedPair* placed, std::size_t count, patch::CutEight& pieces) noexcept {
      ++calls.cut;
      portable().cut(placed, count, pieces);
    },
    [](std::span<const patch::PlacedPair* const> pairs, const patch::Frame& frame, const Vec3& shift,
       double least_depth, patch::CornersOfEight& corners) noexcept {
      ++calls.corners;
      portable().corners(pairs, frame, shift, least_depth, corners);
    },
    [](const patch::PlacedPair& pair, std::span<const Vec3> directions, const Vec3& shift,
       patch::CornersOfEight& corners) noexcept {
      ++calls.corners_along;
      portable().corners_along(pair, directions, shift, corners);
    },
    [](const patch::EightPieces& pieces, const patch::Facing& facing, const Vec3& first,
       patch::FaceSums& sums) noexcept {
      ++calls.same_faces;
      return portable().same_faces(pieces, facing, first, sums);
    },
    [](const patch::EightPieces& pieces, const patch::Facing& facing, const Vec3& flat,
       patch::FaceSums& sums) noexcept {
      ++calls.flat_faces;
      return portable().flat_faces(pieces, facing, flat, sums);
    },
    [](const double* u, const double* v, std::size_t count, std::size_t first, const patch::Fan& fan,
       patch::FanEnds& ends) noexcept {
      ++calls.farthest;
      portable().farthest(u, v, count, first, fan, ends);
    }};

TEST(PatchKernels, OfEachInstructionSetAreItsOwn) {
  std::set<decltype(Kernels::place)> place;
  std::set<decltype(Kernels::farthest)> farthest;
  std::size_t sets = 0;
  for (const InstructionSet set : testing::instruction_sets) {
    const wide::Searches* const searches = wide::searches_for(set);
    if (searches == nullptr) continue;  // not on this processor
    ++sets;
    place.insert(searches->patch.place);
    farthest.insert(searches->patch.farthest);
  }
  EXPECT_EQ(place.size(), sets);
  EXPECT_EQ(farthest.size(), sets);
}

TEST(PatchKernels, AreThoseThatTheBuilderIsGivenThisTime) {
  test::ContactScene scene{test::Body::box(1.0, 1.0, 1.0, 6), test::Body::box(1.0, 1.0, 1.0, 6),
                           test::turn(Vec3(0.1, 0.2, 1.0), 0.3, Vec3(0.2, 0.1, 0.98))};
  scene.find_hits();
  PatchInput input = scene.input();
  input.kernels = &counted;
  calls = {};
  const auto built = scene.builder->build(input);
  const std::vector<Contact> made(built.begin(), built.end());
  for (const int count : {calls.place, calls.cut, calls.corners, calls.same_faces, calls.flat_faces, calls.farthest}) {
    EXPECT_GT(count, 0);
  }
  input.kernels = nullptr;  // the best
  calls = {};
  const auto best = scene.builder->build(input);
  EXPECT_EQ(calls.place + calls.cut + calls.corners + calls.corners_along + calls.same_faces + calls.flat_faces +
                calls.farthest,
            0);
  ASSERT_EQ(made.size(), best.size());
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_EQ(made[i].position, best[i].position);
}

TEST(PatchKernels, OfAPairAreThoseOfItsInstructionSet) {
  const std::shared_ptr<const Shape> shape = Shape::build(testing::wavy_sphere(16)).value();
  const math::Pose pose{Mat3::Identity(), {1.7, 0.0, 0.0}};
  for (const InstructionSet set : {InstructionSet::portable, InstructionSet::best}) {
    Pair::Implementation pair(shape, shape, {.instruction_set = set});
    EXPECT_EQ(pair.wide, wide::searches_for(set));
    wide::Searches searches = *pair.wide;
    searches.patch = counted;
    pair.wide = &searches;
    calls = {};
    run_pair(pair, pose, {.max_contacts = 4});
    EXPECT_FALSE(pair.answer.contacts.empty());
    EXPECT_GT(calls.place, 0);
    EXPECT_GT(calls.cut, 0);
    EXPECT_GT(calls.corners, 0);
    EXPECT_GT(calls.farthest, 0);
    run_pair(pair, {Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix(), pose.translation},
             {.max_contacts = 1});
    EXPECT_FALSE(pair.answer.contacts.empty());
    EXPECT_GT(calls.corners_along, 0);
  }
}

TEST(PatchKernels, OfFacesThatLieOnEachOtherAreGivenToo) {
  const mesh::TriangleMesh two = testing::joined(testing::slab(), testing::slab(), Vec3(1, 0, 0));
  const auto faces = [](const mesh::TriangleMesh& mesh) {
    return std::make_shared<const std::vector<mesh::FlatFace>>(mesh::find_flat_faces(mesh));
  };
  testing::Flush flush(faces(testing::slab()), faces(two), counted);
  math::Pose pose = testing::below(1e-4);
  pose.translation.x() = -0.5;
  flush.move_to(pose, testing::flush_size, true);
  for (const double x : {-0.3, 0.3}) EXPECT_TRUE(flush.explains_at(Vec3(x, 0.0, -0.1)));
  flush.note(true, true);
  calls = {};
  EXPECT_EQ(flush.contacts().size(), 4U);
  EXPECT_GT(calls.farthest, 0);
}

}  // namespace
}  // namespace odds::query
