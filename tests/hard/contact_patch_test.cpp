// Contacts from triangles that no mesh should have, and from more than there is room for.
#include <gtest/gtest.h>

#include <limits>

#include "odds/math/random.hpp"
#include "support/contact_scene.hpp"

namespace odds::query {
namespace {

using test::Body;
using test::ContactScene;
using test::degrees_between;
using test::shift;

void expect_sound(std::span<const Contact> contacts) {
  for (const Contact& c : contacts) {
    EXPECT_TRUE(c.position.allFinite());
    EXPECT_NEAR(c.normal.norm(), 1.0, 1e-12);
    EXPECT_GE(c.depth, 0.0);
    EXPECT_TRUE(std::isfinite(c.depth));
  }
}

/// A soup of points on a coarse lattice: repeated corners, slivers, coplanar and coinciding triangles are frequent.
Body lattice_soup(std::uint64_t seed, std::size_t triangles, double scale) {
  math::Random random(seed);
  Body soup;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    mesh::Triangle t{};
    for (std::uint32_t& corner : t) {
      corner = static_cast<std::uint32_t>(soup.vertices.size());
      const auto coordinate = [&random, scale] { return scale * static_cast<double>(random.below(4)); };
      soup.vertices.emplace_back(coordinate(), coordinate(), coordinate());
    }
    soup.triangles.push_back(t);
  }
  soup.solid = seed % 2 == 0;
  soup.centre = Vec3::Constant(1.5 * scale);
  return soup;
}

TEST(ContactPatchHard, DegenerateTrianglesGiveFiniteContacts) {
  for (const double scale : {1.0, 1e-6, 1e6, 1e-150, 1e15}) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      ContactScene scene{lattice_soup(seed, 12, scale), lattice_soup(seed + 1000, 12, scale), {}};
      scene.probes = seed % 3 == 0;
      const auto contacts = scene.contacts();
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", scale " << scale);
      EXPECT_EQ(contacts.empty(), scene.hits.empty());
      expect_sound(contacts);
    }
  }
}

TEST(ContactPatchHard, EveryHitAloneGivesAContact) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    ContactScene scene{lattice_soup(seed, 12, 1.0), lattice_soup(seed + 1000, 12, 1.0), {}};
    scene.find_hits();
    for (const TrianglePair& hit : std::vector<TrianglePair>(scene.hits)) {
      scene.hits = {hit};
      const auto contacts = scene.builder->build(scene.input());
      EXPECT_FALSE(contacts.empty()) << "seed " << seed << ", pair " << hit.a << " " << hit.b;
      expect_sound(contacts);
    }
  }
}

TEST(ContactPatchHard, CoincidingCopiesGiveFiniteContacts) {
  for (const char* text : {"box:cells=3", "icosphere:frequency=6", "torus:around=16,across=8"}) {
    for (const bool solid : {true, false}) {
      ContactScene scene{Body::made(text, solid), Body::made(text, solid), {}};
      const auto contacts = scene.contacts();
      EXPECT_FALSE(contacts.empty());
      expect_sound(contacts);
    }
  }
}

TEST(ContactPatchHard, MoreHitsThanRoomStillGiveTheNormal) {
  ContactScene scene{Body::box(0.2, 0.5, 0.248, 40), Body::box(1.0, 1.2, 0.3, 40), shift(-0.03, 0.02, -0.274 + 1e-4)};
  scene.find_hits();
  ASSERT_GT(scene.hits.size(), 300u);
  for (const std::size_t room : {8U, 16U, 64U, 256U}) {
    PatchBuilder small(room);
    const auto contacts = small.build(scene.input());
    ASSERT_FALSE(contacts.empty());
    for (const Contact& c : contacts) {
      EXPECT_LE(degrees_between(c.normal, Vec3::UnitZ()), 0.1) << room;
      EXPECT_NEAR(c.depth, 1e-4, 1e-8) << room;
    }
  }
}

TEST(ContactPatchHard, BadIndicesAndCoordinatesAreLeftOut) {
  ContactScene scene{Body::box(0.2, 0.5, 0.25, 1), Body::box(1.0, 1.2, 0.3, 1), shift(0, 0, -0.275 + 1e-4)};
  scene.find_hits();
  const std::vector<TrianglePair> good = scene.hits;
  scene.hits = {{999, 0}, {0, 999}, {no_feature, no_feature}};
  EXPECT_TRUE(scene.builder->build(scene.input()).empty());
  scene.hits.insert(scene.hits.end(), good.begin(), good.end());
  const auto contacts = scene.builder->build(scene.input());
  ASSERT_FALSE(contacts.empty());
  EXPECT_LE(degrees_between(contacts[0].normal, Vec3::UnitZ()), 0.1);
  scene.pose_b_in_a.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(scene.builder->build(scene.input()).empty());
}

TEST(ContactPatchHard, AnyNumberOfContactsAskedForIsClamped) {
  ContactScene scene{Body::box(0.2, 0.5, 0.25, 1), Body::box(1.0, 1.2, 0.3, 1), shift(0, 0, -0.275 + 1e-4)};
  scene.find_hits();
  for (const int wanted : {-5, 0, 1, 2, 3, 8, 9, 1000}) {
    scene.max_contacts = wanted;
    const auto contacts = scene.builder->build(scene.input());
    EXPECT_GE(contacts.size(), 1u);
    EXPECT_LE(contacts.size(), static_cast<std::size_t>(std::clamp(wanted, 1, 8)));
  }
}

}  // namespace
}  // namespace odds::query
