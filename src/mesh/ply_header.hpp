// The header of a PLY file: which elements follow, in which types and byte order.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/text_scanner.hpp"

namespace odds::mesh::ply {

enum class Encoding { ascii, little_endian, big_endian };
enum class Scalar : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] std::size_t size_of(Scalar type) noexcept;
[[nodiscard]] constexpr bool is_integer(Scalar type) noexcept { return type < Scalar::float32; }

struct Property {
  std::string name;
  Scalar type = Scalar::float32;       ///< of the value or of a list's items
  std::optional<Scalar> count_type{};  ///< of a list's length; empty for a single value
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties{};

  [[nodiscard]] std::optional<std::size_t> find(const std::string& property) const noexcept;
  /// The fewest bytes that one such element takes.
  [[nodiscard]] std::uint64_t least_bytes(Encoding encoding) const noexcept;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements{};
  [[nodiscard]] const Element* find(const std::string& element) const noexcept;
};

/// Reads from "ply" through the end of the line "end_header"; the input then stands at the first byte of the data,
/// while its line is still that of "end_header", where errors about the header as a whole belong.
/// Refuses headers that a mesh cannot have, and counts that the bytes behind it cannot hold.
Header read_header(Input& input);

}  // namespace odds::mesh::ply
