// A search that goes on elsewhere after every hit keeps what it leaves open, however many hits there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made(const std::string& name) {
  auto mesh = mesh::made::make_shape("made:" + name);
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
}

std::vector<TrianglePair> crossings(Pair& pair, Method method, const math::Pose& pose, const Budget& budget) {
  pair.reset();
  static_cast<void>(pair.run(pose, {.method = method, .budget = budget, .max_contacts = 8}));
  std::vector<TrianglePair> found(pair.crossings().begin(), pair.crossings().end());
  const auto less = [](const TrianglePair& x, const TrianglePair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; };
  std::sort(found.begin(), found.end(), less);
  return found;
}

void expect_all_are_found(const std::string& name, Method method, const math::Pose& pose) {
  const auto shape = made(name);
  for (const InstructionSet set : {InstructionSet::best, InstructionSet::portable}) {
    auto pair = std::move(Pair::make(shape, shape, {.hit_capacity = 65536, .instruction_set = set})).value();
    const std::vector<TrianglePair> all = crossings(pair, method, pose, {});
    ASSERT_GT(all.size(), 1000U) << name;
    ASSERT_LT(all.size(), 65536U) << name << ": as many as are kept say nothing of the others";
    const std::vector<TrianglePair> spread = crossings(pair, method, pose, Budget::work(1'000'000'000'000));
    ASSERT_EQ(spread.size(), all.size()) << name;
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(spread[i].a, all[i].a) << name;
      ASSERT_EQ(spread[i].b, all[i].b) << name;
    }
  }
}

// Both surfaces meet all along: thousands of hits, after each of which the search goes on in another place.
TEST(SpreadHits, OfAKnotNearlyInItsOwnPlaceAreAllFound) {
  const math::Pose beside{Mat3::Identity(), {1e-6, 2e-6, 5e-7}};
  for (const Method method : {Method::exact, Method::time_critical, Method::incremental}) {
    expect_all_are_found("torus_knot:along=1000,across=50", method, beside);
  }
}

// In its own place a mesh has more hits than can be kept. A room too small for what is open was written beyond here.
TEST(SpreadHits, OfAMeshInItsOwnPlaceFillTheRoomThatThereIs) {
  for (const char* name : {"bumpy_sphere:frequency=60", "torus_knot:along=1000,across=50", "terrain:cells=150"}) {
    const auto shape = made(name);
    for (const InstructionSet set : {InstructionSet::best, InstructionSet::portable}) {
      auto pair = std::move(Pair::make(shape, shape, {.hit_capacity = 65536, .instruction_set = set})).value();
      for (const Method method : {Method::exact, Method::time_critical, Method::incremental}) {
        EXPECT_EQ(crossings(pair, method, {}, Budget::work(1'000'000'000'000)).size(), 65536U) << name;
      }
    }
  }
}

}  // namespace
}  // namespace odds::query
