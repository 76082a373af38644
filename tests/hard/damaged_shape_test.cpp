// Saved shapes that were cut off, altered, or made up: each gives an error that names the byte, none a wrong answer.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "support/all_kinds.hpp"
#include "support/saved_bytes.hpp"
#include "support/shapes.hpp"
#include "support/temporary_folder.hpp"

namespace odds::query {
namespace {

using testing::load;
using testing::saved_bytes;
using tree::Section;

std::string small_file(volume::Kind kind) {
  return saved_bytes(*Shape::build(testing::wavy_sphere(3), {.volume = kind}).value());
}

/// What is amiss with the report on `bytes`, or nothing.
std::string complaint(const std::string& bytes) {
  const auto shape = load(bytes);
  if (shape.ok()) return "it was loaded";
  const Error& error = shape.error();
  if (error.file != "saved" || error.what.empty() || error.remedy.empty()) return "incomplete: " + error.message();
  std::uint64_t byte = 0;
  const char* const begin = error.place.data() + 5;
  const char* const end = error.place.data() + error.place.size();
  const bool named = error.place.starts_with("byte ") && std::from_chars(begin, end, byte).ptr == end;
  if (!named || byte > bytes.size()) return "no byte: " + error.message();
  return "";
}

class DamagedShape : public ::testing::TestWithParam<volume::Kind> {};

TEST_P(DamagedShape, CutOffAtAnyLengthIsAnError) {
  const std::string whole = small_file(GetParam());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_EQ(complaint(whole.substr(0, size)), "") << "cut off at " << size << " of " << whole.size();
  }
  EXPECT_EQ(complaint(whole + '\0'), "");
}

TEST_P(DamagedShape, WithAnyByteAlteredIsAnError) {
  const std::string whole = small_file(GetParam());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << at % 8));
    ASSERT_EQ(complaint(bytes), "") << "byte " << at;
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, DamagedShape, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return testing::name_of(tested.param); });

Error error_of(const std::string& bytes) {
  const auto shape = load(bytes);
  EXPECT_FALSE(shape.ok());
  return shape.ok() ? Error{} : shape.error();
}

TEST(DamagedShapes, OfANewerFormatAreSaidToBeSo) {
  std::string bytes = small_file(volume::Kind::wide);
  tree::SavedHeader header = testing::header_of(bytes);
  header.version = tree::SavedHeader::newest_version + 1;
  testing::put_header(bytes, header);
  testing::reseal(bytes);
  const Error error = error_of(bytes);
  EXPECT_EQ(error.place, "byte 12");
  EXPECT_NE(error.what.find("newer"), std::string::npos) << error.message();
  EXPECT_NE(error_of(testing::other_byte_order(bytes)).what.find("newer"), std::string::npos);
}

TEST(DamagedShapes, OfAnOlderFormatAreSaidToBeSo) {
  std::string bytes = small_file(volume::Kind::wide);
  tree::SavedHeader header = testing::header_of(bytes);
  header.version = 1;
  testing::put_header(bytes, header);
  testing::reseal(bytes);
  const Error error = error_of(bytes);
  EXPECT_EQ(error.place, "byte 12");
  EXPECT_NE(error.what.find("format 1 by an older"), std::string::npos) << error.message();
  EXPECT_NE(error.remedy.find("anew"), std::string::npos) << error.message();
}

TEST(DamagedShapes, SayWhatHappenedToThem) {
  const std::string bytes = small_file(volume::Kind::wide);
  EXPECT_EQ(error_of(bytes.substr(0, 1000)).place, "byte 1000");
  EXPECT_NE(error_of(bytes.substr(0, 1000)).what.find("cut off"), std::string::npos);
  EXPECT_NE(error_of(bytes + "more").what.find("goes on"), std::string::npos);
  EXPECT_NE(error_of("v 0 0 0\n").what.find("not a saved hierarchy"), std::string::npos);
  std::string altered = bytes;
  altered[testing::offset_of(bytes, Section::vertices)] ^= '\x10';
  EXPECT_NE(error_of(altered).what.find("altered"), std::string::npos);
}

/// Writes `value` over record `index` of a section, field `offset` bytes into it, and makes the checksums right.
template <class T>
std::string with(std::string bytes, Section section, std::size_t record_bytes, std::size_t index, std::size_t offset,
                 T value) {
  const std::size_t at = testing::offset_of(bytes, section) + index * record_bytes + offset;
  std::memcpy(bytes.data() + at, &value, sizeof value);
  testing::reseal(bytes);
  return bytes;
}

TEST(DamagedShapes, WithRightChecksumsAreFoundByTheirLinks) {
  using tree::ChildRef;
  using tree::WideNode;
  const std::string wide = small_file(volume::Kind::wide);
  ASSERT_TRUE(load(wide).ok());
  const auto child = [](std::size_t lane) { return offsetof(WideNode, child) + lane * sizeof(ChildRef); };
  const auto node = [&](std::size_t index, std::size_t lane, ChildRef to) {
    return with(wide, Section::wide_nodes, sizeof(WideNode), index, child(lane), to);
  };
  const auto leaf = [&](std::uint32_t triangle) {
    return with(wide, Section::wide_leaves, sizeof(tree::WideLeaf), 0, offsetof(tree::WideLeaf, triangle), triangle);
  };
  const auto statistic = [&](std::size_t offset, auto value) {
    return with(wide, Section::statistics, sizeof(tree::NodeStatistics), 1, offset, value);
  };
  const std::string binary = small_file(volume::Kind::aabb);
  const auto box = [&](std::size_t index, std::size_t offset, std::uint32_t value) {
    return with(binary, Section::nodes, sizeof(tree::Hierarchy<volume::Aabb>::Node), index, offset, value);
  };
  constexpr std::size_t first = sizeof(volume::Aabb);
  const auto extent = [&](std::size_t lane, float half) {
    return with(wide, Section::wide_nodes, sizeof(WideNode), 0, offsetof(WideNode, half) + lane * sizeof half, half);
  };
  const std::string cases[] = {
      extent(7, 1.0F),                      // an empty lane that searches would enter
      extent(0, 1e31F),                     // a volume so large that it reaches empty lanes
      extent(0, -1.0F),                     // a volume without an inside
      node(0, 0, ChildRef::node(0, 1)),     // the root is its own child
      node(0, 0, ChildRef::node(4000, 1)),  // out of range
      node(0, 0, ChildRef::leaf(0, 8)),     // nothing leads to the rest
      node(0, 1, ChildRef::node(1, 1)),     // two roots
      node(1, 0, ChildRef::node(1, 1)),     // a ring
      node(1, 0, ChildRef::leaf(4000, 8)),  // a leaf that is not there
      node(1, 0, ChildRef::nothing()),      // lanes after an empty one
      leaf(1U << 30U),                      // a triangle that is not there
      statistic(offsetof(tree::NodeStatistics, well_filled_cells), std::uint16_t{513}),  // of 512 cells
      statistic(offsetof(tree::NodeStatistics, depth), std::uint8_t{7}),                 // another depth
      statistic(0, std::uint32_t{0x7FC00000}),                                           // a NaN
      statistic(0, std::uint32_t{0xFF800000}),                                           // an infinity
      statistic(offsetof(tree::NodeStatistics, mean_normal), 0x40000000U),  // a mean normal twice as long as any
      statistic(offsetof(tree::NodeStatistics, slab_half), 0xBF800000U),    // a slab of negative thickness
      box(0, first, 0),                                                     // the root is its own child
      box(0, first, 4000),                                                  // out of range
      box(0, first + 4, 3),                                                 // a leaf that was none
      box(1, 0, 0x7FC00000),                                                // a NaN
      with(binary, Section::order, 4, 0, 0, std::uint32_t{4000}),
      with(binary, Section::triangles, 12, 0, 0, std::uint32_t{4000}),
      with(binary, Section::vertices, 24, 0, 0, 1e16),
      with(binary, Section::facts, sizeof(tree::SavedFacts), 0, offsetof(tree::SavedFacts, volume), std::uint64_t{99}),
      with(binary, Section::facts, sizeof(tree::SavedFacts), 0, offsetof(tree::SavedFacts, volume), std::uint64_t{1}),
      with(binary, Section::facts, sizeof(tree::SavedFacts), 0, offsetof(tree::SavedFacts, polygons), std::uint64_t{0}),
      with(binary, Section::facts, sizeof(tree::SavedFacts), 0, offsetof(tree::SavedFacts, triangles),
           std::uint64_t{9}),
      with(binary, Section::facts, sizeof(tree::SavedFacts), 0, offsetof(tree::SavedFacts, levels), std::uint64_t{1})};
  int number = 0;
  for (const std::string& bytes : cases) EXPECT_EQ(complaint(bytes), "") << "case " << number++;
}

TEST(DamagedShapes, NameTheByteOfTheVertexOrTriangleThatIsWrong) {
  const std::string whole = small_file(volume::Kind::aabb);
  const std::size_t vertices = testing::offset_of(whole, Section::vertices);
  const std::size_t triangles = testing::offset_of(whole, Section::triangles);
  const auto place = [](const std::string& bytes) { return error_of(bytes).place; };
  const auto at = [](std::size_t byte) { return "byte " + std::to_string(byte); };
  EXPECT_EQ(place(with(whole, Section::vertices, 24, 2, 8, std::nan(""))), at(vertices + 48));
  EXPECT_EQ(place(with(whole, Section::vertices, 24, 3, 0, 1e16)), at(vertices + 72));
  EXPECT_EQ(place(with(whole, Section::triangles, 12, 5, 0, std::uint32_t{4000})), at(triangles + 60));
  EXPECT_EQ(error_of(with(whole, Section::vertices, 24, 2, 8, std::nan(""))).what, "a number is not finite");
  const std::string free = saved_bytes(*load(whole).value()->without_polygons());
  const std::string far =
      with(free, Section::facts, sizeof(tree::SavedFacts), 0, offsetof(tree::SavedFacts, upper), 1e17);
  EXPECT_EQ(place(far), at(testing::offset_of(free, Section::facts)));
}

TEST(DamagedShapes, NameTheByteOfTheLeafWithACornerThatIsNone) {
  const std::string whole = small_file(volume::Kind::wide);
  const auto with_corner = [&](std::size_t leaf, std::size_t corner, std::size_t axis, std::size_t lane, float value) {
    const std::size_t number = (corner * 3 + axis) * tree::wide_lanes + lane;
    return with(whole, Section::wide_leaves, sizeof(tree::WideLeaf), leaf,
                offsetof(tree::WideLeaf, corner) + number * sizeof value, value);
  };
  const auto expect_error = [&](float value, const std::string& what) {
    for (std::size_t leaf = 0; leaf < 2; ++leaf) {
      for (std::size_t number = 0; number < 9; ++number) {
        for (const std::size_t lane : {0U, 7U}) {
          const Error error = error_of(with_corner(leaf, number / 3, number % 3, lane, value));
          EXPECT_EQ(error.file, "saved");
          const std::size_t byte = testing::offset_of(whole, Section::wide_leaves) + leaf * sizeof(tree::WideLeaf);
          EXPECT_EQ(error.place, "byte " + std::to_string(byte)) << leaf << ' ' << number << ' ' << lane;
          EXPECT_EQ(error.what, what) << leaf << ' ' << number << ' ' << lane;
          EXPECT_FALSE(error.remedy.empty());
        }
      }
    }
  };
  expect_error(std::nanf(""), "a number is not finite");
  expect_error(-std::numeric_limits<float>::infinity(), "a number is not finite");
  expect_error(1e16F, "a number is out of range");
  expect_error(-std::numeric_limits<float>::max(), "a number is out of range");
  EXPECT_TRUE(load(with_corner(0, 0, 0, 0, 3.9e15F)).ok()) << "wrong, but no harm";
}

TEST(DamagedShapes, OfAnotherLayoutKeepTheirRemedy) {
  std::string bytes = small_file(volume::Kind::aabb);
  tree::SavedHeader header = testing::header_of(bytes);
  for (tree::SectionEntry& entry : header.sections) {
    if (entry.id == static_cast<std::uint32_t>(Section::vertices)) ++entry.layout;
  }
  testing::put_header(bytes, header);
  testing::reseal(bytes);
  EXPECT_EQ(error_of(bytes).remedy, "make the file anew with this odds");
}

// The whole file was asked for before its header was looked at.
TEST(DamagedShapes, ThatGoOnForLongTakeNoMemory) {
  const testing::TemporaryFolder folder;
  folder.write("long", small_file(volume::Kind::wide));
  std::filesystem::resize_file(folder / "long", std::uintmax_t{1} << 30U);  // with a hole
  const auto most_kib = [] {
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const auto before = most_kib();
  const auto shape = load_shape(folder / "long");
  ASSERT_FALSE(shape.ok());
  EXPECT_NE(shape.error().what.find("goes on"), std::string::npos) << shape.error().message();
  EXPECT_LT(most_kib() - before, 100'000);
}

TEST(DamagedShapes, ThatAreNoFilesAreErrors) {
  const testing::TemporaryFolder folder;
  folder.write("empty", "");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::string& path : {folder / "empty", folder / "pipe", folder / "missing", folder.path().string()}) {
    const auto shape = load_shape(path);
    ASSERT_FALSE(shape.ok()) << path;
    EXPECT_EQ(shape.error().file, path);
    EXPECT_FALSE(shape.error().remedy.empty()) << path;
    EXPECT_FALSE(is_saved_shape(path)) << path;
  }
}

}  // namespace
}  // namespace odds::query
