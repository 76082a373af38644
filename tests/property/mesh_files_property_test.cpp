// Any mesh that is written is read back the same, in every format that can be read, plain and packed.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <set>

#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::Triangle;
using mesh::TriangleMesh;
using test::PlyEncoding;

/// Doubles of every magnitude that a mesh may have, with many different bit patterns.
rc::Gen<double> coordinate() {
  return rc::gen::map(rc::gen::arbitrary<std::uint64_t>(), [](std::uint64_t bits) {
    const double value = std::bit_cast<double>(bits);
    if (std::abs(value) <= 1e15) return value;
    return static_cast<double>(static_cast<std::int64_t>(bits % 2001) - 1000) / 8;  // also replaces NaN
  });
}

TriangleMesh any_mesh() {
  const auto numbers = *rc::gen::container<std::vector<double>>(coordinate());
  std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    vertices.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  const auto corners = *rc::gen::container<std::vector<std::uint32_t>>(
      rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(vertices.size())));
  std::vector<Triangle> triangles = {{0, 1, 2}};
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return TriangleMesh::make(std::move(vertices), std::move(triangles)).value();
}

TriangleMesh read_back(const std::string& content, const std::string& name) {
  const bool pack = *rc::gen::arbitrary<bool>();
  auto mesh = test::read_content(pack ? test::packed(content) : content, name);
  if (!mesh.ok()) RC_FAIL(mesh.error().message());
  return std::move(mesh).value();
}

/// Bit by bit: also the sign of zero.
bool same(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::bit_cast<std::uint64_t>(a[axis]) != std::bit_cast<std::uint64_t>(b[axis])) return false;
  }
  return true;
}

void expect_same(const TriangleMesh& given, const TriangleMesh& read) {
  RC_ASSERT(read.vertices().size() == given.vertices().size());
  for (std::size_t i = 0; i < given.vertices().size(); ++i) RC_ASSERT(same(given.vertices()[i], read.vertices()[i]));
  RC_ASSERT(
      std::equal(given.triangles().begin(), given.triangles().end(), read.triangles().begin(), read.triangles().end()));
}

/// For STL: the same positions corner by corner, and no two vertices at one position.
void expect_welded(const TriangleMesh& given, const TriangleMesh& read, auto rounded) {
  RC_ASSERT(read.triangles().size() == given.triangles().size());
  std::set<std::array<double, 3>> positions;
  for (const Vec3& v : read.vertices()) RC_ASSERT(positions.insert({v.x() + 0.0, v.y() + 0.0, v.z() + 0.0}).second);
  for (std::size_t t = 0; t < given.triangles().size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 expected = rounded(given.vertices()[given.triangles()[t][corner]]);
      RC_ASSERT(read.vertices()[read.triangles()[t][corner]] == expected);
    }
  }
}

RC_GTEST_PROP(MeshFiles, ObjLosesNothing, ()) {
  const TriangleMesh mesh = any_mesh();
  expect_same(mesh, read_back(test::obj_file(mesh), "m.obj"));
}

RC_GTEST_PROP(MeshFiles, OffLosesNothing, ()) {
  const TriangleMesh mesh = any_mesh();
  expect_same(mesh, read_back(test::off_file(mesh), "m.off"));
}

RC_GTEST_PROP(MeshFiles, PlyLosesNothing, ()) {
  const TriangleMesh mesh = any_mesh();
  for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::little_endian, PlyEncoding::big_endian}) {
    expect_same(mesh, read_back(test::ply_file(mesh, encoding), "m.ply"));
  }
  expect_same(mesh, read_back(test::ply_written(mesh), "m.ply"));
}

RC_GTEST_PROP(MeshFiles, AsciiStlKeepsPositions, ()) {
  const TriangleMesh mesh = any_mesh();
  expect_welded(mesh, read_back(test::stl_ascii_file(mesh), "m.stl"), [](const Vec3& v) { return v; });
}

RC_GTEST_PROP(MeshFiles, BinaryStlRoundsToFloats, ()) {
  const TriangleMesh mesh = any_mesh();
  expect_welded(mesh, read_back(test::stl_binary_file(mesh), "m.stl"),
                [](const Vec3& v) -> Vec3 { return v.cast<float>().cast<double>(); });
}

}  // namespace
}  // namespace odds
