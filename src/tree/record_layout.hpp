// What the records of a saved file are made of, number by number: what swapping their bytes and checking them needs.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/hierarchy.hpp"
#include "odds/tree/wide_tree.hpp"
#include "odds/volume/hull.hpp"

namespace odds::tree {

enum class Scalar : std::uint8_t { f32, f64, u8, u16, u32, u64 };

[[nodiscard]] constexpr std::size_t bytes_of(Scalar scalar) noexcept {
  constexpr std::array<std::size_t, 6> bytes = {4, 8, 1, 2, 4, 8};
  return bytes[static_cast<std::size_t>(scalar)];
}

/// So many numbers of one type in a row.
struct Field {
  Scalar scalar;
  std::uint32_t count;
};

/// Specialised for each record: `fields` in their order, without gaps.
template <class T>
struct RecordLayout;

template <>
struct RecordLayout<char> {
  static constexpr std::array fields = {Field{Scalar::u8, 1}};
};
template <>
struct RecordLayout<std::uint32_t> {
  static constexpr std::array fields = {Field{Scalar::u32, 1}};
};
template <>
struct RecordLayout<Vec3> {
  static constexpr std::array fields = {Field{Scalar::f64, 3}};
};
template <>
struct RecordLayout<mesh::Triangle> {
  static constexpr std::array fields = {Field{Scalar::u32, 3}};
};
template <>
struct RecordLayout<TriangleCorners> {
  static constexpr std::array fields = {Field{Scalar::f64, 9}};
};
template <>
struct RecordLayout<NodeStatistics> {
  static constexpr std::array fields = {Field{Scalar::f32, 21}, Field{Scalar::u16, 1}, Field{Scalar::u8, 2}};
};
template <>
struct RecordLayout<WideNode> {
  static constexpr std::array fields = {Field{Scalar::f32, sizeof(WideNode) / 4 - wide_lanes},
                                        Field{Scalar::u32, wide_lanes}};
};
template <>
struct RecordLayout<WideLeaf> {
  static constexpr std::array fields = {Field{Scalar::f32, 9 * wide_lanes}, Field{Scalar::u32, wide_lanes}};
};

/// A volume consists of single precision numbers, unless it says otherwise.
template <class V>
struct VolumeLayout {
  static constexpr std::array fields = {Field{Scalar::f32, sizeof(V) / 4}};
};
template <>
struct VolumeLayout<volume::Hull> {
  static constexpr std::array fields = {Field{Scalar::f32, sizeof(volume::Obb) / 4 + 2}, Field{Scalar::u32, 1},
                                        Field{Scalar::f32, 3 * volume::Hull::most_vertices}};
};

/// A node of Hierarchy<V>.
template <class V>
struct NodeLayout {
  static constexpr auto fields = [] {
    constexpr auto volume = VolumeLayout<V>::fields;
    std::array<Field, volume.size() + 2> all{};
    std::copy(volume.begin(), volume.end(), all.begin());
    all[volume.size()] = {Scalar::u32, 2};
    all[volume.size() + 1] = {Scalar::f32, 1};
    return all;
  }();
};
template <class T>
requires requires { typename std::remove_cvref_t<decltype(std::declval<T>().volume)>::PreparedPose; }
struct RecordLayout<T> : NodeLayout<decltype(T::volume)> {};

/// The fields of T, which fill it.
template <class T>
[[nodiscard]] constexpr std::span<const Field> layout_of() noexcept {
  constexpr std::size_t bytes = [] {
    std::size_t sum = 0;
    for (const Field& field : RecordLayout<T>::fields) sum += field.count * bytes_of(field.scalar);
    return sum;
  }();
  static_assert(bytes == sizeof(T), "the layout of a saved record has gaps; add or correct its fields");
  return RecordLayout<T>::fields;
}

/// A number that another layout hardly has.
template <class T>
[[nodiscard]] constexpr std::uint64_t layout_code() noexcept {
  std::uint64_t code = 0;
  for (const Field& field : layout_of<T>()) {
    code = code * 1000003U + field.count * 8U + static_cast<std::uint64_t>(field.scalar) + 1U;
  }
  return code;
}

/// Turns records of the other byte order into ours, and back.
inline void swap_records(std::span<std::byte> records, std::span<const Field> fields) noexcept {
  std::byte* at = records.data();
  while (at != records.data() + records.size()) {
    for (const Field& field : fields) {
      const std::size_t bytes = bytes_of(field.scalar);
      for (std::uint32_t i = 0; i < field.count; ++i, at += bytes) std::reverse(at, at + bytes);
    }
  }
}

/// The greatest magnitude of a coordinate or extent; four times that of a mesh leaves room for all that is derived.
inline constexpr auto farthest = static_cast<float>(4.0 * mesh::TriangleMesh::largest_coordinate);

/// The greatest magnitude of the numbers of single precision in a record. Leaves are most of a file: that their corners
/// are in range is found in the same pass as that they are finite, for another takes a sixth of the time to load it.
template <class T>
inline constexpr float most_in = std::numeric_limits<float>::max();
template <>
inline constexpr float most_in<WideLeaf> = farthest;

/// Has its highest bit set if one of `count` floating-point numbers, given by their bits, is more than `most` in
/// magnitude, infinite or none: all these have bits above those of `most`, and carry into the sign when what is left
/// above it is added. Plain sums, so that compilers use vectors.
template <class Bits>
[[nodiscard]] inline Bits overflow_of(const std::byte* at, std::size_t count, Bits most) noexcept {
  constexpr Bits magnitude = std::numeric_limits<Bits>::max() >> 1U;
  const Bits left = magnitude - most;
  Bits carried = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Bits bits = 0;
    std::memcpy(&bits, at + i * sizeof bits, sizeof bits);
    carried |= (bits & magnitude) + left;
  }
  return carried;
}

/// Whether all floating-point numbers of a record are finite, and those of single precision at most `most` in
/// magnitude.
template <class T>
[[nodiscard]] bool is_within(float most, const T& record) noexcept {
  const auto* at = reinterpret_cast<const std::byte*>(&record);
  std::uint32_t in_floats = 0;
  std::uint64_t in_doubles = 0;
  const auto look_at = [&]<std::size_t i>(std::integral_constant<std::size_t, i>) {
    constexpr Field field = RecordLayout<T>::fields[i];
    if constexpr (field.scalar == Scalar::f32) {
      in_floats |= overflow_of(at, field.count, std::bit_cast<std::uint32_t>(most));
    }
    if constexpr (field.scalar == Scalar::f64) {
      in_doubles |= overflow_of(at, field.count, std::bit_cast<std::uint64_t>(std::numeric_limits<double>::max()));
    }
    at += field.count * bytes_of(field.scalar);
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) { (look_at(std::integral_constant<std::size_t, i>()), ...); }
  (std::make_index_sequence<RecordLayout<T>::fields.size()>());
  return (in_floats >> 31U) == 0 && (in_doubles >> 63U) == 0;
}
template <class T>
[[nodiscard]] bool is_finite(const T& record) noexcept {
  return is_within(std::numeric_limits<float>::max(), record);
}

}  // namespace odds::tree
