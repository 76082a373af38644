// Descriptions that mean harm, or would do some by accident: long, deep, many, of odd bytes, in the place of their own
// output.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <set>

#include "haptics/import_fixture.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/write.hpp"

namespace odds::scene {
namespace {

using testing::contents_of;

TEST_F(Import, HostileDescriptionsEndSoonAndHarmlessly) {
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">";
  for (char c = 'b'; c <= 'z'; ++c) {
    bomb += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) bomb += std::string("&") + static_cast<char>(c - 1) + ";";
    bomb += "\">";
  }
  bomb += "]><robot name=\"&z;\"><link name=\"&z;\">" + box_of("1 1 1") + "</link></robot>";
  const ImportedScene exploded = good("bomb.urdf", bomb);  // the name is what stands there, unexpanded
  EXPECT_LT(exploded.text.size(), 2000U);

  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  EXPECT_NE(refused("deep.urdf", deep).what.find("not valid XML"), std::string::npos);
  std::string closed = deep;
  for (int i = 0; i < 200'000; ++i) closed += "</a>";
  EXPECT_NE(refused("deep.urdf", "<robot>" + closed + "</robot>").what.find("no link"), std::string::npos);
  std::string nested;
  for (int i = 0; i < 1000; ++i) nested += "<model name=\"m\">";
  for (int i = 0; i < 1000; ++i) nested += "</model>";
  EXPECT_NE(refused("nested.sdf", sdf(nested)).what.find("nested deeper than 32"), std::string::npos);
  std::string chain;
  for (int i = 0; i < 20'000; ++i) {
    chain += "<link name=\"l" + std::to_string(i) + "\"><pose relative_to=\"l" + std::to_string(i + 1) + "\"/></link>";
  }
  EXPECT_NE(refused("chain.sdf", sdf("<model name=\"m\">" + chain + "</model>")).what.find("no frame"),
            std::string::npos);
  refused("long.urdf", urdf(link("a", "") + "<joint name=\"j\" type=\"fixed\"><parent link=\"" +
                            std::string(2'000'000, 'x') + "\"/><child link=\"a\"/></joint>"));
  EXPECT_NE(refused("large.urdf", urdf(std::string(9'000'000, ' '))).what.find("larger than 8 MiB"), std::string::npos);
  EXPECT_FALSE(import_description(folder_ / "not_there.urdf").ok());
  EXPECT_FALSE(import_description(folder_.path()).ok());
}

TEST_F(Import, NamesCannotLeadOutOfTheFolderOrOfTheirPlaceInTheScene) {
  const std::string evil = "../../../etc/x&quot;&#10;[effects.gravity]&#10;a = &quot;";
  const ImportedScene imported =
      good("r.urdf", urdf(link(evil, box_of("1 1 1")) + link(std::string(250, 'n'), box_of("1 1 1")) +
                          "<joint name=\"j\" type=\"revolute\"><parent link=\"" + evil + "\"/><child link=\"" +
                          std::string(250, 'n') + "\"/></joint>"));
  for (const ImportedMesh& mesh : imported.meshes) {
    EXPECT_EQ(mesh.file.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-/."),
              std::string::npos);
    EXPECT_EQ(mesh.file.find(".."), std::string::npos);
    EXPECT_EQ(mesh.file.rfind("meshes/", 0), 0U);
    EXPECT_LT(mesh.file.size(), 120U);
  }
  const Scene scene = scene_of(imported);
  EXPECT_EQ(scene.bodies.size(), imported.bodies);
}

std::string mesh_of(const std::string& file, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry><mesh filename=\"" + file + "\"/></geometry></collision>";
}

TEST_F(Import, LongNamesAreRefusedBeforeTheyAreMultiplied) {
  const std::string n256(256, 'n');
  const std::string n257(257, 'n');
  EXPECT_EQ(good("r.urdf", urdf(link(n256, box_of("1 1 1")))).bodies, 1U);
  EXPECT_NE(refused("r.urdf", urdf(link(n257, box_of("1 1 1")))).what.find("a name of 257 bytes"), std::string::npos);
  EXPECT_NE(refused("r.urdf", "<robot name=\"" + n257 + "\">" + link("a", box_of("1 1 1")) + "</robot>")
                .what.find("a name of 257 bytes"),
            std::string::npos);
  std::string links;
  for (int i = 0; i < 5000; ++i) links += "<link name=\"" + std::to_string(i) + "\"/>";
  const std::string model = "<model name=\"" + std::string(100'000, 'm') + "\">" + links + "</model>";
  EXPECT_LT(refused("w.sdf", sdf(model)).message().size(), 500U);
  // Together with the models around them.
  std::string nested = "<link name=\"" + std::string(100, 'l') + "\"/>";
  for (int i = 0; i < 2; ++i) nested = "<model name=\"" + std::string(100, 'm') + "\">" + nested + "</model>";
  EXPECT_NE(refused("w.sdf", sdf(nested)).what.find("a name of 304 bytes"), std::string::npos);
}

TEST_F(Import, VerticesThatNoTriangleUsesAreNotCopied) {
  std::string obj;
  for (int i = 0; i < 1000; ++i) obj += "v " + std::to_string(i) + " 0 0\nv 0 " + std::to_string(i) + " 0\n";
  folder_.write("idle.obj", obj + "f 1 3 4\n");
  const ImportedScene imported = good("r.urdf", urdf(link("a", mesh_of("idle.obj") + mesh_of("idle.obj"))));
  ASSERT_EQ(imported.meshes.size(), 1U);
  EXPECT_EQ(imported.meshes[0].mesh.vertices().size(), 6U);
  EXPECT_EQ(imported.meshes[0].mesh.triangles().size(), 2U);
}

TEST_F(Import, BytesThatAreNotUtf8DoNotSpoilTheScene) {
  for (const char* name : {"r\xff", "r\xc0\xaf", "r\xed\xa0\x80", "r\xf4\x90\x80\x80", "r\xe2\x82"}) {
    const ImportedScene imported =
        good("bad\xff.urdf", "<robot name=\"" + std::string(name) + "\">" + link("a", box_of("1 1 1")) + "</robot>");
    EXPECT_EQ(scene_of(imported).bodies.size(), 1U) << imported.text;
  }
  const ImportedScene imported = good("gr\xc3\xbc\xc3\x9f.urdf", "<robot name=\"\xe2\x82\xac\xf0\x9f\x98\x80\">" +
                                                                     link("a", box_of("1 1 1")) + "</robot>");
  EXPECT_EQ(scene_of(imported).bodies.size(), 1U);
  EXPECT_NE(imported.text.find("gr\xc3\xbc\xc3\x9f.urdf"), std::string::npos);
  EXPECT_NE(imported.text.find("\xe2\x82\xac\xf0\x9f\x98\x80::a"), std::string::npos) << imported.text;
}

TEST_F(Import, NothingThatWasReadIsReplaced) {
  const auto block = mesh::made::make_shape("made:box:x=1,y=2,z=3");
  std::filesystem::create_directories(folder_.path() / "robot/meshes");
  ASSERT_FALSE(mesh::write(block.value(), folder_.path() / "robot/meshes/r_l.obj"));
  const std::string before = contents_of(folder_ / "robot/meshes/r_l.obj");
  const ImportedScene imported =
      good("robot/r.urdf", urdf(link("l", mesh_of("meshes/r_l.obj", "<origin xyz=\"1 0 0\"/>"))));
  std::filesystem::create_directory_symlink("robot", folder_.path() / "alias");
  for (const char* folder : {"robot", "alias", "robot/meshes/.."}) {
    const auto error = write_imported(imported, folder_.path() / folder);
    ASSERT_TRUE(error) << folder;
    EXPECT_NE(error->what.find("is one of the files that were read"), std::string::npos) << error->message();
    EXPECT_FALSE(error->remedy.empty());
  }
  EXPECT_EQ(contents_of(folder_ / "robot/meshes/r_l.obj"), before);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "robot/scene.toml"));
  EXPECT_FALSE(write_imported(imported, folder_.path() / "out"));
  const ImportedScene misnamed = good("scene.toml", urdf(link("l", box_of("1 1 1"))));
  const std::string description = contents_of(folder_ / "scene.toml");
  EXPECT_TRUE(write_imported(misnamed, folder_.path()));
  EXPECT_EQ(contents_of(folder_ / "scene.toml"), description);
}

TEST_F(Import, WhatStandsBesideTheFirstWorldIsCounted) {
  const std::string model =
      "<model name=\"m\"><link name=\"l\"><collision name=\"c\"><geometry><box><size>1 1 1</size></box>"
      "</geometry></collision></link></model>";
  const ImportedScene imported = good("w.sdf", sdf(model + "<world name=\"one\">" + model +
                                                   "</world><world name=\"two\">" + model + "</world>" + model));
  EXPECT_EQ(imported.models, 1U);
  EXPECT_TRUE(assumes(imported, "left out: 2 <model>, 1 <world>")) << imported.text;
}

TEST_F(Import, ManyEqualNamesAreNumbered) {
  std::string links;
  std::string joints;
  links += link("root", box_of("1 1 1"));
  for (int i = 0; i < 300; ++i) {  // "a.", "a..", "a...": harmless, they are all the same
    const std::string name = "a" + std::string(static_cast<std::size_t>(i % 250), '.') + (i < 250 ? "" : "/");
    links += link(name, box_of("1 1 1"));
    joints += "<joint name=\"j" + std::to_string(i) + "\" type=\"revolute\"><parent link=\"root\"/><child link=\"" +
              name + "\"/></joint>";
  }
  ImportOptions options;
  options.motion = ImportMotion::fixed;
  const ImportedScene imported = good("r.urdf", urdf(links + joints), options);
  std::set<std::string> files;
  for (const ImportedMesh& mesh : imported.meshes) files.insert(mesh.file);
  EXPECT_EQ(files.size(), 301U);
  EXPECT_TRUE(files.contains("meshes/r_a.obj"));
  EXPECT_TRUE(files.contains("meshes/r_a_.obj"));
  EXPECT_TRUE(files.contains("meshes/r_a__299.obj"));
}

}  // namespace
}  // namespace odds::scene
