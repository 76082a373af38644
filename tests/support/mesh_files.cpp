// Makers of mesh files for tests, independent of the library's writers where it has none.
#include "support/mesh_files.hpp"

#include <zlib.h>

#include <charconv>
#include <sstream>
#include <stdexcept>

#include "odds/mesh/write.hpp"

namespace odds::test {
namespace {

std::string shortest(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string coordinates(const Vec3& p) { return shortest(p.x()) + " " + shortest(p.y()) + " " + shortest(p.z()); }

template <class Writer>
std::string written(Writer writer, const mesh::TriangleMesh& mesh) {
  std::ostringstream out;
  writer(mesh, out);
  return out.str();
}

}  // namespace

Result<mesh::TriangleMesh> read_content(std::string_view content, const std::string& name,
                                        const mesh::ReadOptions& options) {
  return mesh::read_from_memory(std::as_bytes(std::span(content.data(), content.size())), std::nullopt, name, options);
}

std::string packed(std::string_view content) {
  z_stream zlib{};
  if (deflateInit2(&zlib, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("deflateInit2");
  }
  std::string result(deflateBound(&zlib, content.size()), '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  zlib.avail_in = static_cast<uInt>(content.size());
  zlib.next_out = reinterpret_cast<Bytef*>(result.data());
  zlib.avail_out = static_cast<uInt>(result.size());
  const int status = deflate(&zlib, Z_FINISH);
  result.resize(zlib.total_out);
  deflateEnd(&zlib);
  if (status != Z_STREAM_END) throw std::runtime_error("deflate");
  return result;
}

std::string obj_file(const mesh::TriangleMesh& mesh) { return written(mesh::write_obj, mesh); }
std::string stl_binary_file(const mesh::TriangleMesh& mesh) { return written(mesh::write_stl_binary, mesh); }

std::string ply_written(const mesh::TriangleMesh& mesh) { return written(mesh::write_ply, mesh); }

std::string stl_ascii_file(const mesh::TriangleMesh& mesh) {
  std::string text = "solid made\n";
  for (const mesh::Triangle& triangle : mesh.triangles()) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t corner : triangle) text += "   vertex " + coordinates(mesh.vertices()[corner]) + "\n";
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid made\n";
}

std::string off_file(const mesh::TriangleMesh& mesh) {
  std::string text =
      "OFF\n" + std::to_string(mesh.vertices().size()) + " " + std::to_string(mesh.triangles().size()) + " 0\n";
  for (const Vec3& vertex : mesh.vertices()) text += coordinates(vertex) + "\n";
  for (const mesh::Triangle& t : mesh.triangles()) {
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  }
  return text;
}

std::string ply_file(const mesh::TriangleMesh& mesh, PlyEncoding encoding) {
  const bool ascii = encoding == PlyEncoding::ascii;
  const bool big = encoding == PlyEncoding::big_endian;
  std::string file = std::string("ply\nformat ") +
                     (ascii ? "ascii"
                      : big ? "binary_big_endian"
                            : "binary_little_endian") +
                     " 1.0\ncomment made\nelement extra 2\nproperty list uchar short numbers\nproperty float weight\n"
                     "element vertex " +
                     std::to_string(mesh.vertices().size()) +
                     "\nproperty uchar red\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(mesh.triangles().size()) +
                     "\nproperty list uchar int vertex_indices\nproperty list ushort double areas\nend_header\n";
  const auto put = [&](auto value, const char* separator) {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      file += ascii ? shortest(static_cast<double>(value)) + separator : bytes_of(value, big);
    } else {
      file += ascii ? std::to_string(value) + separator : bytes_of(value, big);
    }
  };
  for (std::int16_t i = 0; i < 2; ++i) {
    put(std::uint8_t{2}, " ");
    put(i, " ");
    put(std::int16_t{-7}, " ");
    put(1.5f, "\n");
  }
  for (const Vec3& vertex : mesh.vertices()) {
    put(std::uint8_t{200}, " ");
    put(vertex.x(), " ");
    put(vertex.y(), " ");
    put(vertex.z(), "\n");
  }
  for (const mesh::Triangle& triangle : mesh.triangles()) {
    put(std::uint8_t{3}, " ");
    for (const std::uint32_t corner : triangle) put(static_cast<std::int32_t>(corner), " ");
    put(std::uint16_t{1}, " ");
    put(0.25, "\n");
  }
  return file;
}

std::string stl_claiming(std::uint32_t claimed, std::uint32_t there, const std::string& header) {
  std::string file = header;
  file.resize(80, '\0');
  file += bytes_of(claimed);
  for (std::uint32_t i = 0; i < there; ++i) {
    for (const float coordinate : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
      file += bytes_of(coordinate);
    file += bytes_of(std::uint16_t{0});
  }
  return file;
}

}  // namespace odds::test
