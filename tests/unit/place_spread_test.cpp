// Whether bodies meet in one place, or all around.
#include "query/known/place_spread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "odds/math/tolerances.hpp"
#include "odds/query/pair.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

Vec3 around(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

TEST(PlaceSpread, IsOfWhatStandsStillBetweenTwoCentres) {
  PlaceSpread along_the_line;
  PlaceSpread all_around;
  PlaceSpread concentric;
  for (int run = 0; run < 300; ++run) {
    const double angle = 0.1 * run;  // by which A turns
    along_the_line.begin(2.0 * around(-angle), 0.1);
    along_the_line.see(around(-angle) + 0.1 * around(2.0 * run));
    all_around.begin(2.0 * Vec3::UnitZ(), 0.1);
    all_around.see(around(-angle));
    concentric.begin(0.09 * around(-angle), 0.1);  // too near to say which way
    concentric.see(around(-angle));
  }
  EXPECT_NEAR(along_the_line.metres(), 0.1, 0.02);
  EXPECT_NEAR(all_around.metres(), 1.0, 0.05);
  EXPECT_NEAR(concentric.metres(), 1.0, 0.05);
}

TEST(PlaceSpread, IsOfRecentRunsAndOfNumbers) {
  PlaceSpread spread;
  EXPECT_EQ(spread.metres(), 0.0);
  spread.begin(Vec3::UnitZ(), 0.1);
  spread.see(around(0.0));
  spread.see(around(1.0));
  EXPECT_EQ(spread.metres(), 0.0) << "of two places nobody knows";
  for (int run = 0; run < 300; ++run) {
    spread.begin(Vec3::UnitZ(), 0.1);
    spread.see(around(run));
  }
  ASSERT_GT(spread.metres(), 0.9);
  spread.see(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_GT(spread.metres(), 0.9);
  for (int run = 0; run < 500; ++run) {
    spread.begin(Vec3::UnitZ(), 0.1);
    spread.see(around(0.0));
  }
  EXPECT_LT(spread.metres(), 0.05);
  spread.forget();
  EXPECT_EQ(spread.metres(), 0.0);
}

Vec3 middle_of(const Shape& shape) { return 0.5 * (shape.mesh().lower() + shape.mesh().upper()); }

struct Bodies {
  std::shared_ptr<const Shape> a;
  std::shared_ptr<const Shape> b;

  Bodies(const std::string& name_a, const std::string& name_b)
      : a(Shape::build(std::make_shared<const mesh::TriangleMesh>(testing::made_mesh(name_a))).value()),
        b(Shape::build(std::make_shared<const mesh::TriangleMesh>(testing::made_mesh(name_b))).value()) {}

  /// Of the places of their contacts, as a part of the smaller one's size.
  template <class PoseOf>
  [[nodiscard]] double spread(PoseOf pose_of) const {
    auto pair = std::move(Pair::make(a, b)).value();
    const double size = std::min(a->mesh().size(), b->mesh().size());
    PlaceSpread places;
    for (int tick = 0; tick < 200; ++tick) {
      const math::Pose pose = pose_of(tick);
      places.begin(pose * middle_of(*b) - middle_of(*a), tolerances::hasty_line * size);
      for (const Contact& contact : pair.run(pose, {.max_contacts = 8}).contacts) {
        places.see(contact.position - middle_of(*a));
      }
    }
    return places.metres() / size;
  }
};

TEST(PlaceSpread, TellsGearsFromABoltInItsNut) {
  for (const auto& [teeth_a, teeth_b] : {std::pair{24, 36}, {16, 40}}) {
    const std::string gear = "made:gear:module=0.002,backlash=1e-4,width=0.01,teeth=";
    const Bodies gears(gear + std::to_string(teeth_a), gear + std::to_string(teeth_b));
    const double spread = gears.spread([&, teeth_a = teeth_a, teeth_b = teeth_b](int tick) {
      const double angle = 0.005 * tick;
      const auto turned = [](double by) { return Eigen::AngleAxisd(by, Vec3::UnitZ()).toRotationMatrix(); };
      const math::Pose of_a{turned(angle), Vec3::Zero()};
      const math::Pose of_b{turned(std::numbers::pi / teeth_b - angle * teeth_a / teeth_b + 0.0035),
                            {0.001 * (teeth_a + teeth_b), 0.0, 0.0}};
      return of_a.inverse() * of_b;
    });
    EXPECT_GT(spread, 0.04) << teeth_a;
    EXPECT_LT(spread, tolerances::one_place) << teeth_a;
  }
  const Bodies thread("made:nut", "made:bolt");
  const double spread = thread.spread([&](int tick) {  // it leans to another side all the time
    const double turn = 0.006 * tick;
    const Vec3 to = 5e-5 * around(0.3 * tick);
    return math::Pose{
        Eigen::AngleAxisd(-turn, Vec3::UnitZ()).toRotationMatrix(),
        {to.x(), to.y(), 0.0025 - thread.b->mesh().lower().z() - turn / (2.0 * std::numbers::pi) * 0.00125}};
  });
  EXPECT_GT(spread, tolerances::one_place);
  EXPECT_LT(spread, 0.25);
}

}  // namespace
}  // namespace odds::query
