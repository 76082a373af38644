// Which triangles meet a box.
#include <gtest/gtest.h>

#include <vector>

#include "odds/query/shape.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

class TrianglesInBox : public ::testing::TestWithParam<volume::Kind> {};

// The volume about the box had no size that could be told, and spheres met none such: nothing was found, completely.
TEST_P(TrianglesInBox, AreAllOfThemHoweverLargeItIs) {
  const auto shape = Shape::build(testing::wavy_sphere(6), {.volume = GetParam()}).value();
  const std::size_t all = shape->mesh().triangles().size();
  std::vector<std::uint32_t> found(all);
  for (const double half : {2.0, 1e15, 1e30, 1e100, 1e160, 1e308}) {
    for (const double aside : {0.0, 0.25 * half}) {
      bool complete = false;
      EXPECT_EQ(triangles_in_box(*shape, Vec3(aside, 0, 0), Mat3::Identity(), Vec3::Constant(1.5 * half), found,
                                 UINT64_MAX, &complete),
                all)
          << half << ' ' << aside;
      EXPECT_TRUE(complete) << half;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, TrianglesInBox, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return testing::name_of(tested.param); });

}  // namespace
}  // namespace odds::query
