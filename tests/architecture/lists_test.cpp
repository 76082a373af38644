// What is offered by name is complete: every name has its file, every file its name.
#include <gtest/gtest.h>

#include <set>

#include "architecture/source_tree.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/volume/kind.hpp"

namespace odds::architecture {
namespace {

using Names = std::set<std::string>;

/// File names, without extension, of the headers of a folder that contain `mark`.
Names headers_with(const std::string& folder, std::string_view mark) {
  Names names;
  for (const SourceFile& file : read_files(ODDS_SOURCE_DIR, {folder})) {
    if (!file.path.ends_with(".hpp") || file.text.find(mark) == std::string::npos) continue;
    names.insert(std::filesystem::path(file.path).stem().string());
  }
  return names;
}

/// Names as they stand in file names.
template <class List>
Names as_file_names(const List& list) {
  Names names;
  for (const std::string_view item : list) {
    std::string name(item);
    std::replace(name.begin(), name.end(), '-', '_');
    names.insert(std::move(name));
  }
  return names;
}

TEST(Lists, EveryBoundingVolumeHasItsHeaderAndItsName) {
  EXPECT_EQ(headers_with("include/odds/volume", "static_assert(BoundingVolume<"), as_file_names(volume::kind_names));
}

TEST(Lists, EveryVolumeNameIsAKindAndBack) {
  for (std::size_t i = 0; i < volume::kind_names.size(); ++i) {
    const auto kind = volume::kind_from_name(volume::kind_names[i]);
    ASSERT_TRUE(kind.has_value());
    EXPECT_EQ(static_cast<std::size_t>(*kind), i);
    EXPECT_EQ(volume::name(*kind), volume::kind_names[i]);
  }
  EXPECT_FALSE(volume::kind_from_name("no such volume").has_value());
}

TEST(Lists, TheCInterfaceOffersEveryVolumeUnderItsNumber) {
  const auto files = read_files(ODDS_SOURCE_DIR, {"include/odds/ode/odds_ode.h"});
  ASSERT_EQ(files.size(), 1u);
  for (std::size_t i = 0; i < volume::kind_names.size(); ++i) {
    std::string constant = "ODDS_VOLUME_" + std::string(volume::kind_names[i]);
    std::transform(constant.begin(), constant.end(), constant.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    EXPECT_NE(files[0].text.find(constant + " = " + std::to_string(i)), std::string::npos) << constant;
  }
}

TEST(Lists, EveryMadeShapeHasItsHeaderAndItsName) {
  EXPECT_EQ(headers_with("include/odds/mesh/made", "Result<TriangleMesh> make("),
            as_file_names(mesh::made::shape_names()));
}

}  // namespace
}  // namespace odds::architecture
