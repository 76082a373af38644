// Mesh files that lose nothing (OBJ, PLY) or what their format loses (STL).
#include "odds/mesh/write.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/output_file.hpp"

namespace odds::mesh {
namespace {

/// Gathers small pieces: a stream's formatted output would take most of the time.
class Pieces {
 public:
  explicit Pieces(std::ostream& out) : out_(out) { text_.reserve(flush_at + 256); }
  Pieces(const Pieces&) = delete;
  Pieces& operator=(const Pieces&) = delete;
  ~Pieces() { flush(); }

  Pieces& operator<<(std::string_view text) {
    text_ += text;
    if (text_.size() >= flush_at) flush();
    return *this;
  }
  /// Decimal, shortest form that reads back as the same value.
  template <class Number>
  Pieces& number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return *this << std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
  }
  template <class Number>
  Pieces& little_endian(Number value) {
    auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    return *this << std::string_view(raw.data(), raw.size());
  }

 private:
  static constexpr std::size_t flush_at = std::size_t{1} << 16;
  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& out_;
  std::string text_;
};

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

}  // namespace

void write_obj(const TriangleMesh& mesh, std::ostream& out) {
  Pieces pieces(out);
  for (const Vec3& vertex : mesh.vertices()) {
    pieces << "v ";
    pieces.number(vertex.x()) << " ";
    pieces.number(vertex.y()) << " ";
    pieces.number(vertex.z()) << "\n";
  }
  for (const Triangle& triangle : mesh.triangles()) {
    pieces << "f ";
    pieces.number(std::uint64_t{triangle[0]} + 1) << " ";
    pieces.number(std::uint64_t{triangle[1]} + 1) << " ";
    pieces.number(std::uint64_t{triangle[2]} + 1) << "\n";
  }
}

void write_stl_binary(const TriangleMesh& mesh, std::ostream& out) {
  Pieces pieces(out);
  std::string header = "binary STL, metres";  // must not begin with "solid"
  header.resize(80, ' ');
  pieces << header;
  pieces.little_endian(static_cast<std::uint32_t>(mesh.triangles().size()));
  for (const Triangle& triangle : mesh.triangles()) {
    const auto corner = [&](std::size_t i) -> const Vec3& { return mesh.vertices()[triangle[i]]; };
    // Scaled first: the products of tiny edges vanish.
    const Vec3 u = (corner(1) - corner(0)).stableNormalized();
    const Vec3 v = (corner(2) - corner(0)).stableNormalized();
    const Vec3 normal = u.cross(v).stableNormalized();
    for (int axis = 0; axis < 3; ++axis) pieces.little_endian(static_cast<float>(normal[axis]));
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) pieces.little_endian(static_cast<float>(corner(i)[axis]));
    }
    pieces.little_endian(std::uint16_t{0});
  }
}

void write_ply(const TriangleMesh& mesh, std::ostream& out) {
  Pieces pieces(out);
  pieces << "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex ";
  pieces.number(mesh.vertices().size()) << "\nproperty double x\nproperty double y\nproperty double z\nelement face ";
  pieces.number(mesh.triangles().size()) << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const Vec3& vertex : mesh.vertices()) {
    for (int axis = 0; axis < 3; ++axis) pieces.little_endian(vertex[axis]);
  }
  for (const Triangle& triangle : mesh.triangles()) {
    pieces.little_endian(std::uint8_t{3});
    for (const std::uint32_t corner : triangle) pieces.little_endian(corner);
  }
}

std::optional<Error> write(const TriangleMesh& mesh, const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  void (*writer)(const TriangleMesh&, std::ostream&) = nullptr;
  if (extension == ".obj") writer = write_obj;
  if (extension == ".stl") writer = write_stl_binary;
  if (extension == ".ply") writer = write_ply;
  if (writer == nullptr) {
    return Error{path.string(), "", "cannot tell the format to write from the extension '" + extension + "'",
                 "name the file .obj, .stl or .ply"};
  }
  Result<OutputFile> file = OutputFile::open(path);
  if (!file.ok()) return file.error();
  OutputStream out(file.value());
  writer(mesh, out);
  return file.value().commit();
}

}  // namespace odds::mesh
