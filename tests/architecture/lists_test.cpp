// What is offered by name is complete: every name has its file, every file its name.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "architecture/include_rules.hpp"
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

/// Types, in small letters, that headers of a folder assert to model the concept.
Names models_of(const std::string& folder, const std::string& concept_name) {
  const std::regex assertion("static_assert\\(" + concept_name + "<([A-Za-z0-9_]+)>\\);");
  Names names;
  for (const SourceFile& file : read_files(ODDS_SOURCE_DIR, {folder})) {
    for (std::sregex_iterator found(file.text.begin(), file.text.end(), assertion), end; found != end; ++found) {
      std::string name = (*found)[1];
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      names.insert(std::move(name));
    }
  }
  return names;
}

TEST(Lists, EveryBoundingVolumeHasItsHeaderAndItsName) {
  Names names = as_file_names(volume::kind_names);
  names.erase("wide");  // an engine with volumes of its own, not a model of the concept
  EXPECT_EQ(models_of("include/odds/volume", "BoundingVolume"), names);
}

TEST(Lists, EveryVolumeNameIsAKindAndBack) {
  for (std::size_t i = 0; i < volume::kind_names.size(); ++i) {
    const auto kind = volume::kind_from_name(volume::kind_names[i]);
    ASSERT_TRUE(kind.has_value());
    EXPECT_EQ(static_cast<std::size_t>(*kind), i);
    EXPECT_EQ(volume::name(*kind), volume::kind_names[i]);
  }
  EXPECT_FALSE(volume::kind_from_name("no such volume").has_value());
  for (const std::string_view word : volume::kind_words) EXPECT_TRUE(volume::kind_from_name(word).has_value()) << word;
  EXPECT_EQ(volume::kind_from_name("kdop"), volume::Kind::kdop18);
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

TEST(Lists, EveryEffectHasItsFileAndItsName) {
  Names files;
  for (const SourceFile& file : read_files(ODDS_SOURCE_DIR, {"src/haptics/effects"})) {
    if (file.path.ends_with(".cpp")) files.insert(std::filesystem::path(file.path).stem().string());
  }
  const auto list = read_files(ODDS_SOURCE_DIR, {"src/haptics/effects/list.hpp"});
  ASSERT_EQ(list.size(), 1u);
  static const std::regex entry("X\\(([a-z_]+)\\)");
  Names names;
  for (std::sregex_iterator found(list[0].text.begin(), list[0].text.end(), entry), end; found != end; ++found) {
    names.insert((*found)[1]);
  }
  EXPECT_GT(names.size(), 10u);
  EXPECT_EQ(names, files);
}

TEST(Lists, EveryEffectStandsOnThePageAboutScenes) {
  const auto pages = read_files(ODDS_SOURCE_DIR, {"docs/scenes.md"});
  ASSERT_EQ(pages.size(), 1u);
  for (const SourceFile& file : read_files(ODDS_SOURCE_DIR, {"src/haptics/effects"})) {
    if (!file.path.ends_with(".cpp")) continue;
    const std::string name = std::filesystem::path(file.path).stem().string();
    EXPECT_NE(pages[0].text.find("`[effects." + name + "]`"), std::string::npos) << name;
  }
}

TEST(Lists, EveryRoomIsSomewhereAndIsToldToContributors) {
  const auto pages = read_files(ODDS_SOURCE_DIR, {"CONTRIBUTING.md"});
  ASSERT_EQ(pages.size(), 1u);
  for (const Room& room : rooms) {
    const std::string path = std::string(room.folder) + "/" + std::string(room.name);
    EXPECT_TRUE(std::filesystem::is_directory(std::string(ODDS_SOURCE_DIR) + "/src/" + path)) << path;
    EXPECT_NE(pages[0].text.find("| `" + path + "` |"), std::string::npos) << path;
  }
}

TEST(Lists, EveryMadeShapeHasItsHeaderAndItsName) {
  EXPECT_EQ(headers_with("include/odds/mesh/made", "Result<TriangleMesh> make("),
            as_file_names(mesh::made::shape_names()));
}

}  // namespace
}  // namespace odds::architecture
