// Contacts from a part of the rim: what a search that its budget ended leaves.
#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>

#include "odds/query/contact_patch.hpp"
#include "odds/query/pair.hpp"
#include "support/contact_scene.hpp"

namespace odds::query {
namespace {

using test::Body;
using test::ContactScene;
using test::degrees_between;
using test::shift;
using test::turn;

const Vec3 up = Vec3::UnitZ();

/// Every run of `count` hits that follow each other.
template <class Check>
void for_parts(ContactScene& scene, std::initializer_list<std::size_t> counts, const Check& check) {
  const std::vector<TrianglePair> all = scene.hits;
  for (const std::size_t count : counts) {
    ASSERT_GT(all.size(), count);
    for (std::size_t first = 0; first + count <= all.size(); ++first) {
      scene.hits.assign(all.begin() + static_cast<std::ptrdiff_t>(first),
                        all.begin() + static_cast<std::ptrdiff_t>(first + count));
      check();
    }
  }
  scene.hits = all;
}

// A brick that stands flush on another hangs over by as little as it is deep: a few pieces of the rim along its side
// point anywhere.
TEST(PartOfARim, ThatIsFlushHasTheKnownDirection) {
  const Body brick = Body::box(0.2, 0.5, 0.248, 4);
  for (const double depth : {5e-9, 4e-6}) {
    const math::Pose below = turn({1, 0.5, 0}, 5.0 * depth, {0.9 * depth, 0.6 * depth, 2.0 * depth - 0.248});
    ContactScene scene{brick, brick, below};
    scene.find_hits();
    int astray = 0;
    for_parts(scene, {1, 4, 12, 40}, [&] {
      PatchInput input = scene.input();
      for (const Contact& c : scene.builder->build(input)) astray += degrees_between(c.normal, up) > 8.0 ? 1 : 0;
      input.known_normal = &up;
      input.believed_depth = 5e-5;
      for (const Contact& c : scene.builder->build(input)) {
        EXPECT_LE(degrees_between(c.normal, up), 2.0) << scene.hits.size();
        EXPECT_LE(c.depth, 5e-5);
      }
    });
    EXPECT_LE(astray, 1) << "of 500 parts or so";
  }
}

TEST(PartOfARim, ThatIsFlushAgreesOnADirection) {
  const Body brick = Body::box(0.2, 0.5, 0.248, 4);
  int astray = 0;
  for (const double tilt : {0.0, 2e-5}) {
    ContactScene scene{brick, brick, turn({1, 0.5, 0}, tilt, {3e-6, 2e-6, 0.1 * tilt + 8e-6 - 0.248})};
    scene.find_hits();
    const std::vector<TrianglePair> all = scene.hits;
    for (const std::size_t share : {2U, 4U, 7U, 13U}) {
      for (std::size_t skip = 0; skip < 20; ++skip) {
        scene.hits.clear();
        for (std::size_t i = 0; i < all.size(); ++i) {
          if ((i + skip) % 20 < share) scene.hits.push_back(all[i]);
        }
        PatchInput input = scene.input();
        for (const Contact& c : scene.builder->build(input)) astray += degrees_between(c.normal, up) > 8.0 ? 1 : 0;
        input.believed_depth = 5e-5;
        for (const Contact& c : scene.builder->build(input)) {
          EXPECT_LE(degrees_between(c.normal, up), 2.0) << share << " " << skip;
        }
      }
    }
  }
  EXPECT_EQ(astray, 0);
}

// Two crumbs of the rim on one wall, far from each other as against their height: the area between them says where they
// lie, and along it the bricks overlap from end to end. A brick of a stack was once pushed so, by its whole width.
TEST(PartOfARim, OfCrumbsOnAWallIsNotPushedFromEndToEnd) {
  const Vec3 t(1.2698042840935044e-07, -4.5861708410430903e-08, -1.7590640712448442e-07);
  const math::Pose below =
      math::Pose::from_quaternion({3.410650466266676e-08, -1.2567780565118662e-12, -0.24799612868773069},
                                  Quat(1.0, 0.5 * t.x(), 0.5 * t.y(), 0.5 * t.z()).normalized());
  ContactScene scene{Body::box(0.2, 0.5, 0.248, 11), Body::box(0.2, 0.5, 0.248, 1), below};
  scene.find_hits();
  std::erase_if(scene.hits, [](const TrianglePair& hit) { return hit.b != 5 || (hit.a > 1 && hit.a != 484); });
  ASSERT_EQ(scene.hits.size(), 3u);
  for (const double believed : {0.0, 6e-5}) {
    PatchInput input = scene.input();
    input.believed_depth = believed;
    const auto contacts = scene.builder->build(input);
    ASSERT_FALSE(contacts.empty());
    for (const Contact& contact : contacts) {
      EXPECT_LT(contact.depth, 1e-5);
      EXPECT_GT(std::abs(contact.normal.z()), 0.99);
    }
  }
}

TEST(PartOfARim, OnAWallKeepsItsNormalWhateverIsKnown) {
  const Body box = Body::box(0.1, 0.2, 0.3, 4);
  const Body floor = Body::box(0.6, 0.6, 0.1, 4).moved(shift(0.1, 0, -0.19995));
  const Body wall = Body::box(0.1, 0.6, 0.5, 4).moved(shift(0.09999, 0.01, 0.063));
  ContactScene scene{box, floor.with(wall), {}};
  scene.find_hits();
  std::erase_if(scene.hits, [&](const TrianglePair& hit) { return hit.b < floor.triangles.size(); });
  int against_the_wall = 0;
  for_parts(scene, {1, 4, 12, 40}, [&] {
    PatchInput input = scene.input();
    const auto own = scene.builder->build(input);
    const std::vector<Contact> alone(own.begin(), own.end());
    input.known_normal = &up;
    input.believed_depth = 6e-5;
    const auto made = scene.builder->build(input);
    ASSERT_EQ(made.size(), alone.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
      if (degrees_between(alone[i].normal, -Vec3::UnitX()) > 8.0) continue;
      ++against_the_wall;
      EXPECT_LE(degrees_between(made[i].normal, alone[i].normal), 1e-9);
    }
  });
  EXPECT_GT(against_the_wall, 100);
}

// Pieces of a rim that curls span areas of both signs about their middle: what is left of their sum put a contact
// beside both bodies, by twice a radius.
TEST(PartOfARim, ThatCurlsHasItsContactsWhereTheBodiesAre) {
  const auto shape_of = [](const char* name) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
  };
  Pair pair =
      Pair::make(shape_of("torus:ring=0.25,tube=0.1,around=120,across=48"), shape_of("uv_sphere:radius=0.25")).value();
  Request request;
  request.max_contacts = 2;
  for (const math::Pose& pose : {shift(0.08, 0.1, 0.11), shift(0.03, 0.1, -0.09), shift(-0.1, 0.07, -0.09)}) {
    pair.reset();
    const Answer& answer = pair.run(pose, request);
    ASSERT_EQ(pair.crossings().size(), PairOptions{}.hit_capacity);
    ASSERT_FALSE(answer.contacts.empty());
    for (const Contact& c : answer.contacts) {
      EXPECT_LE((c.position - pose.translation).norm(), 0.25 + 0.5 * c.depth);
      EXPECT_LE(c.position.head<2>().norm(), 0.35 + 0.5 * c.depth);
    }
  }
}

}  // namespace
}  // namespace odds::query
