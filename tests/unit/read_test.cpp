// Choosing the format, options, files and gzip; the writers' errors.
#include "odds/mesh/read.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "odds/mesh/write.hpp"
#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::TriangleMesh;
using test::packed;
using test::read_content;

const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TriangleMesh triangle() { return TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}).value(); }

class Folder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("odds_read_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path put(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  std::filesystem::path folder_;
};

TEST(Read, ChoosesTheFormatByContentThenByName) {
  const TriangleMesh mesh = triangle();
  for (const std::string name : {"m", "m.dat", "m.obj", "m.STL.gz"}) {
    EXPECT_TRUE(read_content(test::ply_file(mesh, test::PlyEncoding::big_endian), name).ok()) << name;
    EXPECT_TRUE(read_content(test::off_file(mesh), name).ok()) << name;
    EXPECT_TRUE(read_content(test::stl_binary_file(mesh), name).ok()) << name;
  }
  EXPECT_TRUE(read_content(test::stl_ascii_file(mesh), "m").ok());
  EXPECT_TRUE(read_content("# a comment\n\n" + obj, "m").ok());
  EXPECT_TRUE(read_content("group of words\n" + obj, "m.OBJ").ok());
  EXPECT_FALSE(read_content("group of words\n" + obj, "m").ok());
}

TEST(Read, PassesOverAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  const std::string with_unused = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";
  for (const std::string name : {"m.obj", "m"}) {
    const auto mesh = read_content(mark + with_unused, name);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    EXPECT_EQ(mesh.value().vertices().size(), 4U) << name;
    EXPECT_EQ(mesh.value().vertices()[1], Vec3(1, 0, 0)) << name;
  }
  const TriangleMesh mesh = triangle();
  EXPECT_TRUE(read_content(mark + test::off_file(mesh), "m.off").ok());
  EXPECT_TRUE(read_content(mark + test::stl_ascii_file(mesh), "m.stl").ok());
  EXPECT_TRUE(read_content(mark + test::ply_file(mesh, test::PlyEncoding::ascii), "m.ply").ok());
  std::string binary = test::stl_binary_file(mesh);
  binary.replace(0, mark.size(), mark);  // there the header is free text
  EXPECT_TRUE(read_content(binary, "m.stl").ok());
}

TEST(Read, TakesTheFormatThatItIsTold) {
  const std::string text = "words\n" + obj;
  EXPECT_TRUE(mesh::read_from_memory(std::as_bytes(std::span(text)), mesh::Format::obj, "m.stl").ok());
}

TEST(Read, ScalesToMetres) {
  const auto mesh = read_content(obj, "m.obj", {.scale = 0.001});
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh.value().vertices()[1], Vec3(0.001, 0, 0));
}

TEST(Read, UnpacksGzipWhateverTheName) {
  for (const std::string name : {"m.obj.gz", "m.obj", "m"}) EXPECT_TRUE(read_content(packed(obj), name).ok()) << name;
  EXPECT_TRUE(read_content(obj, "m.obj.gz").ok());
}

TEST(Read, UnpacksSeveralMembersAsOneFile) {
  const auto mesh = read_content(packed(obj.substr(0, 11)) + packed("") + packed(obj.substr(11)), "m.obj.gz");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message();
  EXPECT_EQ(mesh.value().triangles().size(), 1u);
}

TEST(Read, ReadsTextLongerThanItsWindow) {
  std::string text = "# " + std::string(300'000, 'c') + "\n";
  for (int i = 0; i < 30'000; ++i) text += "v " + std::to_string(i) + " 0.5 " + std::to_string(i % 7) + "\n";
  text += "f";
  for (int i = 1; i <= 30'000; ++i)
    text += std::string(i % 500 == 0 ? 9000 : 1, ' ') + std::to_string(i) + "//" + std::to_string(i);
  for (const std::string& content : {text, packed(text)}) {
    const auto mesh = read_content(content, "long.obj");
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    ASSERT_EQ(mesh.value().triangles().size(), 29'998u);
    for (std::uint32_t i = 0; i < 29'998; ++i)
      ASSERT_EQ(mesh.value().triangles()[i], (mesh::Triangle{0, i + 1, i + 2}));
    for (int i = 0; i < 30'000; ++i) ASSERT_EQ(mesh.value().vertices()[std::size_t(i)], Vec3(i, 0.5, i % 7));
  }
}

TEST_F(Folder, FilesAreReadAndWritten) {
  for (const std::string extension : {".obj", ".stl", ".PLY"}) {
    const auto path = folder_ / ("m" + extension);
    const auto error = mesh::write(triangle(), path);
    ASSERT_FALSE(error) << error->message();
    const auto mesh = mesh::read(path);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    EXPECT_EQ(mesh.value().triangles()[0], (mesh::Triangle{0, 1, 2}));
    EXPECT_EQ(mesh.value().name(), path.string());
  }
  EXPECT_TRUE(mesh::read(put("packed.obj.gz", packed(obj))).ok());
}

TEST_F(Folder, SystemErrorsNameTheFile) {
  const auto absent = mesh::read(folder_ / "absent.obj");
  ASSERT_FALSE(absent.ok());
  EXPECT_EQ(absent.error().file, (folder_ / "absent.obj").string());
  EXPECT_NE(absent.error().what.find("No such file"), std::string::npos) << absent.error().message();
  const auto directory = mesh::read(folder_);
  ASSERT_FALSE(directory.ok());
  EXPECT_NE(directory.error().what.find("not a regular file"), std::string::npos) << directory.error().message();

  const auto nowhere = mesh::write(triangle(), folder_ / "absent" / "m.obj");
  ASSERT_TRUE(nowhere);
  EXPECT_NE(nowhere->what.find("No such file"), std::string::npos) << nowhere->message();
  const auto unknown = mesh::write(triangle(), folder_ / "m.xyz");
  ASSERT_TRUE(unknown);
  EXPECT_NE(unknown->what.find(".xyz"), std::string::npos) << unknown->message();
}

TEST(Write, FullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  const auto link = std::filesystem::path(::testing::TempDir()) / "odds_full.obj";
  std::filesystem::remove(link);
  std::filesystem::create_symlink("/dev/full", link);
  const auto error = mesh::write(triangle(), link);
  std::filesystem::remove(link);
  ASSERT_TRUE(error);
  EXPECT_NE(error->what.find("No space"), std::string::npos) << error->message();
}

}  // namespace
}  // namespace odds
