// Mesh files made in memory: every format that can be read, from a mesh, and reading them back.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "odds/mesh/read.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::test {

/// Reads `content` as if it were the file `name`.
Result<mesh::TriangleMesh> read_content(std::string_view content, const std::string& name,
                                        const mesh::ReadOptions& options = {});
/// `content` as gzip writes it.
std::string packed(std::string_view content);

std::string obj_file(const mesh::TriangleMesh& mesh);
std::string stl_binary_file(const mesh::TriangleMesh& mesh);
/// As mesh::write_ply writes it.
std::string ply_written(const mesh::TriangleMesh& mesh);
std::string stl_ascii_file(const mesh::TriangleMesh& mesh);
std::string off_file(const mesh::TriangleMesh& mesh);
enum class PlyEncoding { ascii, little_endian, big_endian };
/// Coordinates as doubles, indices as int, with an extra element and extra properties to pass over.
std::string ply_file(const mesh::TriangleMesh& mesh, PlyEncoding encoding);

/// The bytes of a number, in the byte order asked for.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  const std::uint16_t probe = 1;
  const bool host_is_big = *reinterpret_cast<const unsigned char*>(&probe) == 0;
  if (big_endian != host_is_big) bytes.assign(bytes.rbegin(), bytes.rend());
  return bytes;
}

/// A binary STL file that claims `claimed` triangles and holds `there` copies of one.
std::string stl_claiming(std::uint32_t claimed, std::uint32_t there, const std::string& header = "made");

}  // namespace odds::test
