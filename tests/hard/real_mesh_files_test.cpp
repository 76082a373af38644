// Meshes that others made: those beside the source tree with their counts, and those of the package openfoam-examples.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "odds/mesh/read.hpp"

namespace odds {
namespace {

namespace fs = std::filesystem;

/// The fields of a line of CSV, of which some are quoted.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> found(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      found.emplace_back();
    } else {
      found.back() += c;
    }
  }
  return found;
}

TEST(RealMeshFiles, HaveTheCountsOfTheirIndex) {
  const fs::path folder = fs::path(ODDS_SOURCE_DIR).parent_path() / "shared" / "meshes";
  std::ifstream index(folder / "INDEX.csv");
  if (!index) GTEST_SKIP() << "no meshes beside the source tree";
  std::string line;
  std::getline(index, line);
  std::map<std::string, std::size_t> column;
  for (const std::string& name : fields(line)) column.emplace(name, column.size());
  std::size_t count = 0;
  while (std::getline(index, line)) {
    const std::vector<std::string> row = fields(line);
    const std::string file = row.at(column.at("file"));
    const auto mesh = mesh::read(folder / file);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    EXPECT_EQ(mesh.value().triangles().size(), std::stoul(row.at(column.at("triangles")))) << file;
    // The index counts the vertices that faces use; those of STL are welded, the others keep theirs.
    const bool stl = row.at(column.at("format")).starts_with("stl");
    EXPECT_EQ(mesh.value().vertices().size(),
              std::stoul(row.at(column.at(stl ? "vertices_welded" : "vertices_in_file"))))
        << file;
    for (int axis = 0; axis < 3; ++axis) {
      const double least = std::stod(row.at(column.at(std::string("min_") + "xyz"[axis])));
      const double most = std::stod(row.at(column.at(std::string("max_") + "xyz"[axis])));
      EXPECT_NEAR(mesh.value().lower()[axis], least, 1e-6 * (1 + std::abs(least))) << file;
      EXPECT_NEAR(mesh.value().upper()[axis], most, 1e-6 * (1 + std::abs(most))) << file;
    }
    ++count;
  }
  EXPECT_GT(count, 0u);
}

bool is_mesh_file(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.ends_with(".obj") || name.ends_with(".obj.gz") || name.ends_with(".stl") || name.ends_with(".stl.gz");
}

TEST(RealMeshFiles, OfOpenFoamAreRead) {
  const fs::path folder = "/usr/share/doc/openfoam-examples/examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "the package openfoam-examples is not installed";
  std::map<std::string, std::size_t> triangles;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_mesh_file(entry.path())) continue;
    const std::string name = entry.path().filename().string();
    if (triangles.contains(name)) continue;  // many examples hold the same file
    const auto mesh = mesh::read(entry.path());
    triangles[name] = mesh.ok() ? mesh.value().triangles().size() : 0;
    if (mesh.ok()) continue;
    // A curve is no surface, and the error says so.
    EXPECT_EQ(name, "curve.obj") << mesh.error().message();
    EXPECT_NE(mesh.error().what.find("line elements"), std::string::npos) << mesh.error().message();
  }
  EXPECT_EQ(triangles["motorBike.obj.gz"], 331653u);
  EXPECT_EQ(triangles["DTC-scaled.stl.gz"], 116062u);
  EXPECT_EQ(triangles["flange.stl.gz"], 6468u);
}

}  // namespace
}  // namespace odds
