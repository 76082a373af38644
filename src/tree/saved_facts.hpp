// The single numbers of a saved hierarchy.
#pragma once

#include <array>
#include <cstdint>

#include "tree/record_layout.hpp"

namespace odds::tree {

/// Lengths in metres. A volume's number is that of volume::Kind, which never changes.
struct SavedFacts {
  std::array<double, 3> origin{};  ///< of the hierarchy's frame, in the mesh's
  double reach = 0.0;
  std::array<double, 3> lower{};  ///< of the mesh's bounding box
  std::array<double, 3> upper{};
  double tau = 0.0;
  double mean_well_filled_cells = 0.0;
  double build_ms = 0.0;
  std::uint64_t volume = 0;
  std::uint64_t leaf_triangles = 0;
  std::uint64_t triangles = 0;
  std::uint64_t leaves = 0;
  std::uint64_t levels = 0;
  std::uint64_t solid = 0;     ///< 0 or 1
  std::uint64_t polygons = 0;  ///< 0: none are in the file
};

template <>
struct RecordLayout<SavedFacts> {
  static constexpr std::array fields = {Field{Scalar::f64, 13}, Field{Scalar::u64, 7}};
};

}  // namespace odds::tree
