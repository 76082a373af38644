// Arrays in large pages.
#include "odds/mesh/side_by_side.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "odds/tree/wide_tree.hpp"

namespace odds::mesh {
namespace {

template <class T>
SharedArray<T> counted(std::size_t count) {
  std::vector<T> elements(count);
  std::iota(elements.begin(), elements.end(), T{1});
  return elements;
}
template <class T>
bool is_counted(const SharedArray<T>& array) {
  T next{1};
  for (const T& element : array.span()) {
    if (element != next++) return false;
  }
  return true;
}
bool is_at_line(const void* place) { return reinterpret_cast<std::uintptr_t>(place) % 64 == 0; }
bool has_large_pages() { return LargePages::make(LargePages::least_bytes) != nullptr; }

TEST(SideBySide, MovedArraysHaveTheirElements) {
  if (!has_large_pages()) GTEST_SKIP() << "no large pages here";
  auto a = counted<double>(400'001);
  auto b = counted<std::uint32_t>(7);
  auto c = counted<std::uint32_t>(300'000);
  const double* const before = a.data();
  put_side_by_side(a, b, c);
  EXPECT_NE(a.data(), before);
  EXPECT_TRUE(is_counted(a) && is_counted(b) && is_counted(c));
  EXPECT_EQ(a.size(), 400'001U);
  EXPECT_EQ(b.size(), 7U);
  for (const void* place :
       {static_cast<const void*>(a.data()), static_cast<const void*>(b.data()), static_cast<const void*>(c.data())}) {
    EXPECT_TRUE(is_at_line(place));
  }
  EXPECT_LE(static_cast<const void*>(a.data() + a.size()), static_cast<const void*>(b.data()));
  EXPECT_LE(static_cast<const void*>(b.data() + b.size()), static_cast<const void*>(c.data()));
}

TEST(SideBySide, TheBlockLivesAsLongAsAnyOfItsArrays) {
  std::optional<SharedArray<double>> a = counted<double>(300'000);
  auto b = counted<std::uint32_t>(1000);
  const auto copy_of_before = *a;
  put_side_by_side(*a, b);
  a.reset();
  EXPECT_TRUE(is_counted(b));
  EXPECT_TRUE(is_counted(copy_of_before));
}

TEST(SideBySide, LittleStaysWhereItIs) {
  auto a = counted<double>(1000);
  SharedArray<double> nothing;
  const double* const before = a.data();
  put_side_by_side(a, nothing);
  EXPECT_EQ(a.data(), before);
  EXPECT_TRUE(is_counted(a));
  EXPECT_TRUE(nothing.empty());
}

TEST(SideBySide, EveryRoomIsWithinItsBlock) {
  constexpr std::size_t page = std::size_t{2} << 20U;
  for (const std::size_t bytes : {LargePages::least_bytes, page - 1, page, page + 1, page + page / 4 * 3, 3 * page}) {
    const auto memory = LargePages::make(bytes);
    if (!memory) GTEST_SKIP() << "no large pages here";
    EXPECT_TRUE(is_at_line(memory.get()));
    memory.get()[0] = std::byte{1};
    memory.get()[bytes - 1] = std::byte{2};
    LargePages::settle(memory, bytes);
    EXPECT_EQ(memory.get()[0], std::byte{1});
    EXPECT_EQ(memory.get()[bytes - 1], std::byte{2});
  }
  EXPECT_EQ(LargePages::make(LargePages::least_bytes - 1), nullptr);
}

TEST(SideBySide, NodesOfALargeTreeComeBeforeItsLeaves) {
  if (!has_large_pages()) GTEST_SKIP() << "no large pages here";
  const auto mesh = made::make_shape("made:bumpy_sphere:frequency=50");
  ASSERT_TRUE(mesh.ok());
  const auto tree = tree::WideTree::build(mesh.value(), {});
  const auto& nodes = tree.parts().nodes.span();
  EXPECT_EQ(static_cast<const void*>(nodes.data() + nodes.size()), static_cast<const void*>(tree.leaves()));
}

}  // namespace
}  // namespace odds::mesh
