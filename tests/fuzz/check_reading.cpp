// The claims that read.hpp makes about any result.
#include "check_reading.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace odds::fuzz {
namespace {

bool is_packed(std::span<const std::byte> bytes) {
  return bytes.size() >= 2 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b};
}

std::string mesh_complaint(const mesh::TriangleMesh& mesh) {
  if (mesh.triangles().empty()) return "a mesh without triangles";
  for (const Vec3& vertex : mesh.vertices()) {
    if (!(vertex.cwiseAbs().maxCoeff() <= mesh::TriangleMesh::largest_coordinate)) return "a coordinate out of range";
  }
  for (const mesh::Triangle& triangle : mesh.triangles()) {
    if (*std::max_element(triangle.begin(), triangle.end()) >= mesh.vertices().size()) return "an index out of range";
  }
  return "";
}

/// "12" or "byte 12", both perhaps followed by " (unpacked)" or " (packed)", inside the input.
std::string place_complaint(const std::string& place, std::span<const std::byte> bytes) {
  const bool byte = place.starts_with("byte ");
  const char* const begin = place.data() + (byte ? 5 : 0);
  const char* const end = place.data() + place.size();
  std::uint64_t number = 0;
  const auto [after, status] = std::from_chars(begin, end, number);
  const std::string_view rest(after, static_cast<std::size_t>(end - after));
  if (status != std::errc{} || (!rest.empty() && (!byte || (rest != " (packed)" && rest != " (unpacked)")))) {
    return "a place that is neither a line nor a byte: '" + place + "'";
  }
  if (!byte && number == 0) return "line 0";
  if (is_packed(bytes) && rest != " (packed)") return "";  // the unpacked size is not known here
  const auto breaks = static_cast<std::uint64_t>(std::count_if(
      bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{'\n'} || b == std::byte{'\r'}; }));
  if (number > (byte ? bytes.size() : breaks + 1)) return "a place behind the end: '" + place + "'";
  return "";
}

}  // namespace

std::string complaint(const Result<mesh::TriangleMesh>& result, std::span<const std::byte> bytes,
                      const std::string& name) {
  if (result.ok()) return mesh_complaint(result.value());
  const Error& error = result.error();
  if (error.file != name || error.what.empty() || error.remedy.empty())
    return "an incomplete error: " + error.message();
  if (error.message().size() > 1000) return "an endless error: " + error.message();
  const std::string found = place_complaint(error.place, bytes);
  return found.empty() ? "" : found + " in: " + error.message();
}

void read_and_check(std::span<const std::byte> bytes, std::optional<mesh::Format> format) {
  const std::string name = "input";
  const std::string found = complaint(mesh::read_from_memory(bytes, format, name), bytes, name);
  if (found.empty()) return;
  std::fprintf(stderr, "%s\n", found.c_str());
  std::abort();
}

}  // namespace odds::fuzz
