// Descriptions written into a folder of their own, and imported.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "odds/scene/import.hpp"
#include "odds/scene/scene.hpp"
#include "support/temporary_folder.hpp"

namespace odds::scene {

class Import : public ::testing::Test {
 protected:
  Result<ImportedScene> import(const std::string& name, const std::string& text, const ImportOptions& options = {}) {
    folder_.write(name, text);
    return import_description(folder_ / name, options);
  }
  ImportedScene good(const std::string& name, const std::string& text, const ImportOptions& options = {}) {
    auto imported = import(name, text, options);
    EXPECT_TRUE(imported.ok()) << (imported.ok() ? "" : imported.error().message());
    return imported.ok() ? std::move(imported).value() : ImportedScene{};
  }
  Error refused(const std::string& name, const std::string& text) {
    const auto imported = import(name, text);
    EXPECT_FALSE(imported.ok()) << text.substr(0, 300);
    if (imported.ok()) return {};
    EXPECT_EQ(imported.error().file, folder_ / name);
    EXPECT_FALSE(imported.error().what.empty());
    EXPECT_FALSE(imported.error().remedy.empty()) << imported.error().message();
    return imported.error();
  }
  Scene scene_of(const ImportedScene& imported) {
    EXPECT_FALSE(write_imported(imported, folder_.path() / "out"));
    auto scene = read_scene(folder_.path() / "out/scene.toml");
    EXPECT_TRUE(scene.ok()) << scene.error().message();
    return std::move(scene).value();
  }
  static bool assumes(const ImportedScene& scene, const std::string& words) {
    for (const std::string& sentence : scene.assumptions) {
      if (sentence.find(words) != std::string::npos) return true;
    }
    return false;
  }
  testing::TemporaryFolder folder_;
};

inline void expect_box(const mesh::TriangleMesh& mesh, const Vec3& lower, const Vec3& upper, double within) {
  EXPECT_LT((mesh.lower() - lower).norm(), within) << mesh.lower().transpose();
  EXPECT_LT((mesh.upper() - upper).norm(), within) << mesh.upper().transpose();
}

inline std::string urdf(const std::string& inside) {
  return "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" + inside + "\n</robot>\n";
}
inline std::string sdf(const std::string& inside) { return "<sdf version=\"1.9\">\n" + inside + "\n</sdf>\n"; }
inline std::string link(const std::string& name, const std::string& inside) {
  return "<link name=\"" + name + "\">" + inside + "</link>\n";
}
inline std::string box_of(const std::string& size, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry><box size=\"" + size + "\"/></geometry></collision>";
}

}  // namespace odds::scene
