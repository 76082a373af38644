// A single contact of a single pair of triangles is what the machinery for many pairs makes of it.
#include "query/patch/one_pair.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/primitive/triangle_triangle.hpp"
#include "query/wide/searches.hpp"
#include "support/instruction_sets.hpp"

namespace odds::query::patch {
namespace {

constexpr std::array<mesh::Triangle, 1> one = {mesh::Triangle{0, 1, 2}};

/// Two triangles that meet, of solids and sheets, with and without a run before.
struct Meeting {
  std::array<Vec3, 3> a;
  std::array<Vec3, 3> b;
  std::array<TrianglePair, 1> hits{};
  Vec3 previous_normal;
  Vec3 previous_position = Vec3::Zero();
  Vec3 came;
  PatchInput input;

  explicit Meeting(std::uint64_t stream) {
    math::Random random(45, stream);
    const double thin = stream % 5 == 0 ? 0.01 : 1.0;  // nearly flat on each other, or crossing at any angle
    const auto corner = [&] { return Vec3(random.uniform(), random.uniform(), thin * random.uniform()); };
    if (stream % 2 == 0) input.pose_b_in_a = {random.rotation().toRotationMatrix(), 0.2 * random.direction()};
    std::array<Vec3, 3> placed;
    do {
      for (std::size_t k = 0; k < 3; ++k) {
        a[k] = corner();
        placed[k] = corner();
        b[k] = input.pose_b_in_a.inverse() * placed[k];
      }
    } while (!primitive::triangles_intersect(a.data(), placed.data()));
    previous_normal = random.direction();
    came = random.direction();
    input.hits = hits;
    input.vertices_a = a;
    input.vertices_b = b;
    input.triangles_a = input.triangles_b = one;
    input.max_contacts = 1;
    input.solid_a = stream % 3 != 0;
    input.solid_b = stream % 7 != 0;
    input.reference_a = 2.0 * random.direction();
    input.reference_b = 2.0 * random.direction();
    if (stream % 11 < 5) {
      input.previous_normal = &previous_normal;
      input.previous_position = &previous_position;
    }
    if (stream % 13 < 5) input.came = &came;
  }
  Meeting(const Meeting&) = delete;
  Meeting& operator=(const Meeting&) = delete;

  [[nodiscard]] Vec3 middle_of_rim() const {
    PlacedPair placed;
    EXPECT_EQ(best_kernels().place(input, input.hits, &placed), 1U);
    std::array<RimPiece, most_pieces_of_a_pair> pieces;
    EXPECT_EQ(rim_pieces(placed, false, 0, pieces), 1U);
    return pieces[0].middle();
  }
  /// The machinery's.
  [[nodiscard]] Contact by_many(PatchBuilder& builder) const {
    const std::span<const Contact> contacts = builder.build(input);
    EXPECT_EQ(contacts.size(), 1U);
    return contacts.front();
  }
};

TEST(OnePair, IsWhatTheMachineryForManyMakesOfIt) {
  PatchBuilder builder(16);
  std::size_t taken = 0;
  std::size_t flat = 0;
  for (std::uint64_t stream = 0; stream < 20000; ++stream) {
    const Meeting meeting(stream);
    const auto contact = contact_of_one_pair(meeting.input, best_kernels());
    if (!contact) continue;
    ++taken;
    const Contact expected = meeting.by_many(builder);
    EXPECT_GT(contact->normal.dot(expected.normal), 1.0 - 1e-12) << "stream " << stream;
    EXPECT_NEAR(contact->normal.norm(), 1.0, 1e-12);
    // The machinery takes one far out of those that are nearly the deepest.
    EXPECT_GE(contact->depth, expected.depth - 1e-12) << "stream " << stream;
    EXPECT_LE(contact->depth, expected.depth / 0.95 + 1e-12) << "stream " << stream;
    // It stands over the middle of the rim, no higher or lower than the triangles overlap there.
    const Vec3 apart = contact->position - meeting.middle_of_rim();
    EXPECT_LE((apart - apart.dot(contact->normal) * contact->normal).norm(), 1e-9) << "stream " << stream;
    EXPECT_EQ(contact->triangle_a, 0U);
    EXPECT_EQ(contact->triangle_b, 0U);
    const Vec3 face = (meeting.a[1] - meeting.a[0]).cross(meeting.a[2] - meeting.a[0]).normalized();
    flat += std::abs(face.dot(contact->normal)) > 1.0 - 1e-12 ? 1U : 0U;
  }
  EXPECT_GT(taken, 19000U);
  EXPECT_GT(flat, 1000U);
  EXPECT_LT(flat, taken - 1000U);
}

TEST(OnePair, IsTheSameWhenTheBodiesAreExchanged) {
  std::size_t taken = 0;
  std::size_t others = 0;
  for (std::uint64_t stream = 0; stream < 3000; ++stream) {
    Meeting meeting(stream);
    if (!meeting.input.solid_a || !meeting.input.solid_b) continue;
    meeting.input.previous_normal = meeting.input.came = nullptr;
    PatchInput exchanged = meeting.input;
    const math::Pose& pose = meeting.input.pose_b_in_a;
    exchanged.pose_b_in_a = pose.inverse();
    std::swap(exchanged.vertices_a, exchanged.vertices_b);
    const auto contact = contact_of_one_pair(meeting.input, best_kernels());
    const auto other = contact_of_one_pair(exchanged, best_kernels());
    if (!contact || !other) continue;
    ++taken;
    if (contact->normal.dot(pose.rotation * other->normal) > -1.0 + 1e-9) {
      ++others;
      continue;
    }
    EXPECT_NEAR(contact->depth, other->depth, 1e-9) << stream;
    EXPECT_LE((contact->position - pose * other->position).norm(), 1e-9) << stream;
  }
  EXPECT_GT(taken, 1000U);
  EXPECT_LE(others, taken / 200);  // two directions as good; one in ten when B's face came before A's
}

TEST(OnePair, HasTheSameBitsOnAllInstructionSets) {
  for (std::uint64_t stream = 0; stream < 500; ++stream) {
    const Meeting meeting(stream);
    const auto expected = contact_of_one_pair(meeting.input, wide::searches_for(InstructionSet::portable)->patch);
    for (const InstructionSet set : testing::instruction_sets) {
      const wide::Searches* const searches = wide::searches_for(set);
      if (searches == nullptr) continue;  // not on this processor
      const auto contact = contact_of_one_pair(meeting.input, searches->patch);
      ASSERT_EQ(contact.has_value(), expected.has_value());
      if (!contact) continue;
      EXPECT_EQ(contact->position, expected->position);
      EXPECT_EQ(contact->normal, expected->normal);
      EXPECT_EQ(contact->depth, expected->depth);
    }
  }
}

TEST(OnePair, LeavesToTheMachineryWhatNeedsMoreCare) {
  const auto contact_of = [](const auto& change) {
    Meeting meeting(1);
    change(meeting);
    return contact_of_one_pair(meeting.input, best_kernels());
  };
  ASSERT_TRUE(contact_of([](Meeting&) {}).has_value());
  EXPECT_FALSE(contact_of([](Meeting& m) { m.hits[0].a = 1; }).has_value());
  EXPECT_FALSE(contact_of([](Meeting& m) { m.hits[0].b = no_feature; }).has_value());
  EXPECT_FALSE(contact_of([](Meeting& m) { m.input.vertices_b = m.input.vertices_b.first(2); }).has_value());
  for (const double none : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(contact_of([none](Meeting& m) { m.a[2].y() = none; }).has_value());
    EXPECT_FALSE(contact_of([none](Meeting& m) { m.b[0].x() = none; }).has_value());
  }
  const auto place = [](const Vec3& u, const Vec3& v, const Vec3& w) {
    return [=](Meeting& m) {
      m.input.pose_b_in_a = {};
      m.a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
      m.b = {u, v, w};
    };
  };
  // A corner on a face, a corner on a corner, faces on each other, a triangle without area.
  EXPECT_FALSE(contact_of(place({0.2, 0.2, 0.0}, {0.2, 0.3, 1.0}, {0.3, 0.2, 1.0})).has_value());
  EXPECT_FALSE(contact_of(place({0.0, 0.0, 0.0}, {-1.0, 0.3, 1.0}, {-1.0, 0.2, 1.0})).has_value());
  EXPECT_FALSE(contact_of(place({0.1, 0.1, 0.0}, {0.1, 0.9, 0.0}, {0.9, 0.1, 0.0})).has_value());
  EXPECT_FALSE(contact_of(place({0.2, 0.2, -1.0}, {0.2, 0.2, 1.0}, {0.2, 0.2, 0.5})).has_value());
}

}  // namespace
}  // namespace odds::query::patch
