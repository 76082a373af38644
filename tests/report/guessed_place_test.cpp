// Where bodies probably meet, against where they do.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/report/accuracy/contact_region.hpp"
#include "odds/report/accuracy/poses.hpp"

namespace odds::report {
namespace {

/// The position of an answer that two microseconds leave without a proof. Bodies overlap by 1 % of their size.
TEST(GuessedPlace, OfRoundBodiesLiesInWhatOverlaps) {
  const auto knot =
      query::Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape("made:torus_knot").value()))
          .value();
  auto maker = std::move(PoseMaker::make(knot, knot, Procedure::distance, 3)).value();
  const auto bands = pose_bands(Procedure::distance);
  const auto band = static_cast<std::uint64_t>(
      std::find_if(bands.begin(), bands.end(), [](const auto& one) { return one.least == -0.01; }) - bands.begin());
  ASSERT_LT(band, bands.size());
  auto guess = std::move(query::Pair::make(knot, knot)).value();
  query::PairOptions all;
  all.hit_capacity = 65536;
  auto truth = std::move(query::Pair::make(knot, knot, all)).value();
  std::vector<double> off;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const math::Pose pose = maker.pose(i * bands.size() + band).value().pose();
    guess.reset();
    const query::Answer& guessed = guess.run(pose, {.budget = query::Budget::work(64)});
    if (guessed.basis == query::Basis::proved || !guessed.has_cell_pair) continue;
    ASSERT_EQ(truth.run(pose, {.method = query::Method::exact, .max_contacts = 8}).verdict, query::Verdict::hit);
    const ContactRegion region(*knot, *knot, pose, truth.crossings());
    off.push_back(region.distance(guessed.cell_pair.position) / maker.size());
  }
  ASSERT_GT(off.size(), 40U);
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[off.size() / 2], 1e-3) << "between the middles of the patches it is 3e-3";
}

}  // namespace
}  // namespace odds::report
