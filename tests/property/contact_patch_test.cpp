// What must hold for contacts of any two shapes in any pose.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "odds/math/random.hpp"
#include "support/contact_scene.hpp"

namespace odds::query {
namespace {

using test::Body;
using test::ContactScene;
using test::degrees_between;

const std::vector<Body>& shapes() {
  static const std::vector<Body> all = {Body::box(0.2, 0.5, 0.25, 1), Body::box(0.3, 0.2, 0.1, 4),
                                        Body::made("icosphere:radius=0.15,frequency=8"),
                                        Body::made("torus:ring=0.15,tube=0.05,around=24,across=12"),
                                        Body::made("peg:radius=0.05,length=0.4,chamfer=0.01,around=16,along=4")};
  return all;
}

/// Two shapes in a random pose that overlap by a few millimetres along a random direction.
ContactScene random_scene(std::uint64_t seed) {
  math::Random random(seed, 17);
  const auto pick = [&random] { return shapes()[random.below(shapes().size())]; };
  ContactScene scene{pick(), pick(), {}};
  scene.pose_b_in_a.rotation = random.rotation().toRotationMatrix();
  const Vec3 direction = random.direction();
  double near = 0.0;
  double far = 1.5;
  for (int i = 0; i < 20; ++i) {  // bisection to the touch, from outside
    const double middle = 0.5 * (near + far);
    scene.pose_b_in_a.translation = middle * direction;
    scene.find_hits();
    (scene.hits.empty() ? far : near) = middle;
  }
  scene.pose_b_in_a.translation = (near - random.uniform(1e-4, 5e-3)) * direction;
  scene.find_hits();
  return scene;
}

constexpr std::uint64_t scenes = 100;

/// The scenes are found once: bisection by brute force takes longer than everything else here.
const ContactScene& scene_of(std::uint64_t seed) {
  static const std::vector<ContactScene> all = [] {
    std::vector<ContactScene> made;
    for (std::uint64_t i = 0; i < scenes; ++i) made.push_back(random_scene(i));
    return made;
  }();
  return all[seed];
}

ContactScene exchanged(const ContactScene& scene) {
  ContactScene other{scene.b, scene.a, scene.pose_b_in_a.inverse()};
  for (const TrianglePair& hit : scene.hits) other.hits.push_back({hit.b, hit.a});
  return other;
}

std::vector<Contact> build(const ContactScene& scene) {
  const auto made = scene.builder->build(scene.input());
  return {made.begin(), made.end()};
}

bool same(const std::vector<Contact>& a, const std::vector<Contact>& b) {
  return std::ranges::equal(a, b, [](const Contact& p, const Contact& q) {
    return p.position == q.position && p.normal == q.normal && p.depth == q.depth && p.triangle_a == q.triangle_a &&
           p.triangle_b == q.triangle_b;
  });
}

TEST(ContactPatchProperty, RaysCastTwoAtATimeMakeTheSameContacts) {
  static int pairs_of_rays;
  pairs_of_rays = 0;
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    ContactScene scene = scene_of(seed);
    scene.a.solid = scene.a.solid && seed % 3 != 0;  // of a sheet both ways are asked
    PatchInput input = scene.input();
    const auto one_at_a_time = scene.builder->build(input);
    const std::vector<Contact> expected(one_at_a_time.begin(), one_at_a_time.end());
    input.probe_both = [](const DepthProbe& a, ProbeRay& ray_a, const DepthProbe& b, ProbeRay& ray_b) noexcept {
      ++pairs_of_rays;
      for (auto [probe, ray] : {std::pair(&a, &ray_a), std::pair(&b, &ray_b)}) {
        ray->found =
            probe->ray(probe->self, ray->origin, ray->direction, ray->max_distance, &ray->distance, &ray->triangle);
      }
    };
    const auto made = scene.builder->build(input);
    ASSERT_TRUE(same({made.begin(), made.end()}, expected)) << seed;
  }
  EXPECT_GT(pairs_of_rays, 500);
}

TEST(ContactPatchProperty, ContactsAreFiniteUnitFewAndWithinTheOverlap) {
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const ContactScene& scene = scene_of(seed);
    const auto contacts = build(scene);
    SCOPED_TRACE(seed);
    ASSERT_EQ(contacts.empty(), scene.hits.empty());
    ASSERT_LE(contacts.size(), 8u);
    for (const Contact& c : contacts) {
      EXPECT_TRUE(c.position.allFinite());
      EXPECT_NEAR(c.normal.norm(), 1.0, 1e-12);
      EXPECT_GE(c.depth, 0.0);
      EXPECT_LT(c.triangle_a, scene.a.triangles.size());
      EXPECT_LT(c.triangle_b, scene.b.triangles.size());
    }
  }
}

TEST(ContactPatchProperty, MovingByTheDepthsEndsTheOverlapOrLeavesFarLess) {
  int separated = 0;
  int all = 0;
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    ContactScene scene = scene_of(seed);
    const auto contacts = build(scene);
    if (contacts.empty()) continue;
    // One patch: its own way out. A vertex of the polyhedron may hide from the probes between its places: a tenth more.
    const bool one_patch = std::all_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
      return degrees_between(c.normal, contacts[0].normal) < 1e-6;
    });
    if (!one_patch) continue;
    scene.pose_b_in_a.translation -= (1.1 * contacts[0].depth + 1e-5) * contacts[0].normal;
    scene.find_hits();
    ++all;
    separated += scene.hits.empty() ? 1 : 0;
  }
  EXPECT_GT(all, 50);
  EXPECT_GE(separated, all * 9 / 10) << separated << " of " << all;
}

TEST(ContactPatchProperty, ExchangingTheBodiesTurnsTheNormalsAround) {
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const ContactScene& scene = scene_of(seed);
    const auto there = build(scene);
    auto back = build(exchanged(scene));
    SCOPED_TRACE(seed);
    ASSERT_EQ(there.empty(), back.empty());
    if (there.empty()) continue;
    for (Contact& c : back) c.normal = -(scene.pose_b_in_a.rotation * c.normal);
    EXPECT_NEAR(there[0].depth, back[0].depth, 0.04 * there[0].depth + 1e-9);
    EXPECT_LE((there[0].normal - back[0].normal).norm(), 1e-6);
    // Which of many equal points of a patch are taken depends on the frame; the patches do not.
    for (const Contact& c : there) {
      const auto same = [&c](const Contact& d) { return (c.normal - d.normal).norm() < 1e-6; };
      EXPECT_TRUE(std::any_of(back.begin(), back.end(), same));
    }
  }
}

TEST(ContactPatchProperty, MovingBothBodiesMovesTheContacts) {
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const ContactScene& scene = scene_of(seed);
    const auto before = build(scene);
    math::Random random(seed, 23);
    const math::Pose motion{random.rotation().toRotationMatrix(), 3.0 * random.direction()};
    ContactScene moved = scene;
    moved.a = scene.a.moved(motion);
    moved.pose_b_in_a = motion * scene.pose_b_in_a;
    const auto after = build(moved);
    SCOPED_TRACE(seed);
    ASSERT_EQ(before.empty(), after.empty());
    if (before.empty()) continue;
    EXPECT_NEAR(before[0].depth, after[0].depth, 0.04 * before[0].depth + 1e-9);
    EXPECT_LE((motion.rotation * before[0].normal - after[0].normal).norm(), 1e-6);
  }
}

TEST(ContactPatchProperty, SameInputSameBits) {
  for (std::uint64_t seed = 0; seed < scenes; ++seed) {
    const ContactScene& scene = scene_of(seed);
    const auto first = build(scene);
    static_cast<void>(build(scene_of((seed + 7) % scenes)));  // whatever the builder did in between
    const auto second = build(scene);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].position, second[i].position);
      EXPECT_EQ(first[i].normal, second[i].normal);
      EXPECT_EQ(first[i].depth, second[i].depth);
    }
  }
}

}  // namespace
}  // namespace odds::query
