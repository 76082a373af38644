// Faults of real meshes against figures that an independent program counted (../shared/meshes/INDEX.csv).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "odds/mesh/faults.hpp"
#include "odds/mesh/read.hpp"
#include "odds/mesh/repair.hpp"

namespace odds::mesh {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> split_quoted(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) fields.emplace_back();
    if (c != '"' && c != '\r' && (c != ',' || quoted)) fields.back() += c;
  }
  return fields;
}

std::filesystem::path folder() { return std::filesystem::path(ODDS_SOURCE_DIR).parent_path() / "shared/meshes"; }

std::vector<Row> reference_rows() {
  std::ifstream file(folder() / "INDEX.csv");
  std::vector<Row> rows;
  std::string line;
  if (!std::getline(file, line)) return rows;
  const std::vector<std::string> header = split_quoted(line);
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split_quoted(line);
    Row row;
    for (std::size_t i = 0; i < header.size() && i < fields.size(); ++i) row[header[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

class ReferenceMeshes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder() / "INDEX.csv")) GTEST_SKIP() << "no folder of reference meshes";
  }
};

TEST_F(ReferenceMeshes, FaultsMatchTheFiguresOfTheIndex) {
  const std::vector<Row> rows = reference_rows();
  ASSERT_GE(rows.size(), 24u);
  for (Row row : rows) {
    SCOPED_TRACE(row["file"]);
    const auto mesh = read(folder() / row["file"]);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    const Faults faults = find_faults(mesh.value());
    const auto count = [&](const char* column) { return static_cast<std::size_t>(std::stoul(row[column])); };
    const auto yes = [&](const char* column) { return row[column] == "yes"; };
    EXPECT_EQ(mesh.value().triangles().size(), count("triangles"));
    EXPECT_EQ(faults.closed, yes("closed"));
    EXPECT_EQ(faults.manifold, yes("manifold"));
    EXPECT_EQ(faults.orientable, yes("orientable"));
    EXPECT_EQ(faults.consistent(), yes("consistent_winding"));
    EXPECT_EQ(faults.degenerate.count, count("degenerate"));
    EXPECT_EQ(faults.duplicate.count, count("duplicate"));
    EXPECT_EQ(faults.boundary.count, count("boundary_edges"));
    EXPECT_EQ(faults.non_manifold.count, count("nonmanifold_edges"));
    EXPECT_EQ(faults.non_manifold_vertex.count, count("nonmanifold_vertices"));
    EXPECT_EQ(faults.inconsistent.count, count("inconsistent_edges"));
    EXPECT_EQ(faults.components, count("parts"));
  }
}

TEST_F(ReferenceMeshes, RepairLeavesNothingThatItSaysItMends) {
  for (Row row : reference_rows()) {
    SCOPED_TRACE(row["file"]);
    const auto mesh = read(folder() / row["file"]);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    const auto repaired = repair(mesh.value());
    ASSERT_TRUE(repaired.ok());
    const Faults faults = find_faults(repaired.value().mesh);
    EXPECT_EQ(faults.degenerate.count, 0u);
    EXPECT_EQ(faults.duplicate.count, 0u);
    EXPECT_EQ(faults.duplicate_vertex.count, 0u);
    EXPECT_EQ(faults.unused_vertex.count, 0u);
    if (faults.orientable) {
      EXPECT_EQ(faults.inconsistent.count, 0u);
    }
    const auto again = repair(repaired.value().mesh);
    ASSERT_TRUE(again.ok());
    EXPECT_FALSE(again.value().log.changed());
  }
}

}  // namespace
}  // namespace odds::mesh
