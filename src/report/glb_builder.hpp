// A glTF 2.0 document with one binary buffer, as a GLB file (Khronos, glTF 2.0 specification, 2021).
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "odds/math/error.hpp"

namespace odds::report {

/// Collects accessors and whatever else the caller puts into `json`.
class GlbBuilder {
 public:
  GlbBuilder();

  /// Index of a new accessor over floats; `components` is 1 (SCALAR), 3 (VEC3) or 4 (VEC4). Bounds are written.
  std::size_t floats(std::span<const float> numbers, std::size_t components, bool of_vertices = false);
  /// Index of a new accessor over vertex numbers.
  std::size_t indices(std::span<const std::uint32_t> numbers);
  /// Index of a new node.
  std::size_t node(nlohmann::ordered_json node);
  /// One sampler and one channel of the first animation.
  void animate(std::size_t node, const char* path, std::size_t times, std::size_t values, const char* interpolation);

  /// The greatest size that a GLB file's header can state.
  static constexpr std::uint64_t largest_file = std::numeric_limits<std::uint32_t>::max();

  /// The file: header, JSON, binary, each padded to four bytes. An error if it had more than `most_bytes`.
  [[nodiscard]] Result<std::string> file(std::uint64_t most_bytes = largest_file);

  nlohmann::ordered_json json;

 private:
  std::size_t view(std::string_view bytes, int target);
  std::string bytes_;
};

}  // namespace odds::report
