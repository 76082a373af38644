// Boxes about the upper nodes of a hierarchy: a tree whose leaves enclose the mesh.
#include "odds/query/upper_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

class UpperBoxes : public ::testing::TestWithParam<volume::Kind> {
 protected:
  std::shared_ptr<const Shape> shape = Shape::build(testing::wavy_sphere(24), {.volume = GetParam()}).value();
};

bool holds(const UpperBox& box, const Vec3& point) {
  return ((point - box.center).cwiseAbs().array() <= box.half.array() + 1e-6).all();
}

TEST_P(UpperBoxes, AreATreeOfNoMoreThanAreWanted) {
  for (const std::size_t most : {0U, 1U, 5U, 100U, 1000U}) {
    const auto boxes = upper_boxes(*shape, most);
    EXPECT_LE(boxes.size(), most);
    EXPECT_GE(boxes.size(), std::min<std::size_t>(most, most >= 100 ? most / 3 : 1));
    std::vector<int> parents(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::uint32_t k = 0; k < boxes[i].children; ++k) {
        ASSERT_LT(boxes[i].first + k, boxes.size());
        ASSERT_GT(boxes[i].first + k, i);
        ++parents[boxes[i].first + k];
      }
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(parents[i], i == 0 ? 0 : 1) << i;
  }
}

TEST_P(UpperBoxes, EncloseTheMeshAtEveryDepth) {
  for (const std::size_t most : {1U, 20U, 300U}) {
    const auto boxes = upper_boxes(*shape, most);
    for (const Vec3& vertex : shape->mesh().vertices()) {
      const bool held = std::any_of(boxes.begin(), boxes.end(),
                                    [&](const UpperBox& box) { return box.children == 0 && holds(box, vertex); });
      EXPECT_TRUE(held) << vertex.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, UpperBoxes, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& kind) { return testing::name_of(kind.param); });

}  // namespace
}  // namespace odds::query
