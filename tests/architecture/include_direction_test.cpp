// Includes go down the layers only, and third-party headers stay in their rooms.
#include <gtest/gtest.h>

#include "architecture/include_rules.hpp"

namespace odds::architecture {
namespace {

Violations judge(std::string path, std::string text) { return judge_includes({std::move(path), std::move(text)}); }

TEST(IncludeRules, AcceptDownwardAndOwnIncludes) {
  EXPECT_EQ(judge("include/odds/query/pair.hpp", "#include <vector>\n#include \"odds/tree/node.hpp\"\n"), Violations{});
  EXPECT_EQ(
      judge("src/query/pair/pair.cpp", "#include \"query/search/search.hpp\"\n#include \"odds/query/pair.hpp\"\n"),
      Violations{});
  EXPECT_EQ(judge("src/ode/geom/geom.cpp", "#include <ode/ode.h>\n#include \"ode/mesh/mesh_data.hpp\"\n"),
            Violations{});
  EXPECT_EQ(judge("src/scene/reader.cpp", "#include <toml++/toml.h>\n"), Violations{});
}

TEST(IncludeRules, RefuseAnIncludeUpwards) {
  const Violations found = judge("include/odds/tree/node.hpp", "// top\n  # include \"odds/query/pair.hpp\"\n");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0], "include/odds/tree/node.hpp: includes odds/query/pair.hpp: up or sideways from layer 3 to 5");
}

TEST(IncludeRules, RefuseAnIncludeSideways) {
  EXPECT_EQ(judge("src/mesh/read.cpp", "#include \"odds/primitive/closest.hpp\"\n").size(), 1u);
  EXPECT_EQ(judge("src/report/page.cpp", "#include \"scene/scene.hpp\"\n").size(), 1u);
  EXPECT_EQ(judge("src/report/page.cpp", "#include <odds/scene/scene.hpp>\n").size(), 1u);
}

TEST(IncludeRules, RoomsOfAFolderGoDownToo) {
  EXPECT_EQ(judge("src/query/wide/exact.hpp", "#include \"query/patch/rim.hpp\"\n#include \"query/spending.hpp\"\n"),
            Violations{});
  EXPECT_EQ(judge("src/query/patch/rim.cpp", "#include \"query/wide/exact.hpp\"\n"),
            Violations{"src/query/patch/rim.cpp: includes query/wide/exact.hpp: up or sideways within query/"});
  EXPECT_EQ(judge("src/query/ray/ray.cpp", "#include \"query/shape/box_mesh.hpp\"\n").size(), 1u);
  EXPECT_EQ(judge("src/query/spending.cpp", "#include \"query/search/search.hpp\"\n").size(), 1u);
  EXPECT_EQ(judge("src/query/attic/old.cpp", "").size(), 1u);
  EXPECT_EQ(judge("src/query/pair/pair.cpp", "#include \"query/attic/old.hpp\"\n").size(), 1u);
}

TEST(IncludeRules, RefuseOdeOutsideItsRoom) {
  EXPECT_EQ(judge("src/haptics/step.cpp", "#include <ode/ode.h>\n").size(), 1u);
  EXPECT_EQ(judge("include/odds/query/answer.hpp", "#include <ode/contact.h>\n").size(), 1u);
}

TEST(IncludeRules, RefusePrivateThingsInPublicHeaders) {
  for (const char* name : {"<toml++/toml.h>", "<nlohmann/json.hpp>", "<CLI/CLI.hpp>", "<fmt/core.h>",
                           "\"scene/parse.hpp\"", "\"parse.hpp\""}) {
    EXPECT_EQ(judge("include/odds/scene/scene.hpp", std::string("#include ") + name + "\n").size(), 1u) << name;
  }
}

TEST(IncludeRules, RefuseFoldersWithoutALayer) {
  EXPECT_EQ(judge("src/utils/misc.hpp", "").size(), 1u);
  EXPECT_EQ(judge("include/odds/everything.hpp", "").size(), 1u);
  EXPECT_EQ(judge("src/query/pair/pair.cpp", "#include \"odds/utils/misc.hpp\"\n").size(), 1u);
}

TEST(TheHouse, IncludesGoDownOnly) {
  int judged = 0;
  Violations found;
  for (const SourceFile& file : read_files(ODDS_SOURCE_DIR, {"include", "src"})) {
    if (!is_code(file.path)) continue;
    ++judged;
    append(found, judge_includes(file));
  }
  EXPECT_GT(judged, 15);
  EXPECT_TRUE(found.empty()) << join(found);
}

}  // namespace
}  // namespace odds::architecture
