// The numbers about the surface inside a node that probabilities are made from.
#pragma once

#include <cstdint>

#include "odds/math/types.hpp"

namespace odds::tree {

/// Statistics of all triangles below one node, in the hierarchy's frame. Metres, square metres. 88 bytes.
struct NodeStatistics {
  float area = 0.0F;                  ///< total area of the triangles
  float relative_area = 0.0F;         ///< area / (bounding volume)^(2/3), no unit
  float log_relative_area = -1e4F;    ///< log2 of it
  float log_volume = 0.0F;            ///< log2 of the bounding volume in m^3
  Vec3f centroid = Vec3f::Zero();     ///< area-weighted
  Vec3f mean_normal = Vec3f::Zero();  ///< area-weighted mean of unit normals; its length (0 .. 1) says how flat
  float normal_moment[6] = {1.F / 3, 1.F / 3, 1.F / 3, 0, 0, 0};  ///< E[n n^T]: xx yy zz xy xz yz; trace 1
  Vec3f slab_normal = Vec3f::UnitZ();  ///< thinnest principal axis of the surface; at most 1 long, at least 1 - 2^-20
  float slab_center = 0.0F;            ///< every vertex x: |slab_normal . x - slab_center| <= slab_half
  float slab_half = 0.0F;
  std::uint16_t well_filled_cells = 0;  ///< s_A of the book: of 512
  std::uint8_t depth = 0;               ///< of the node, root = 0
  std::uint8_t height = 0;              ///< levels below it, leaf = 0
};

}  // namespace odds::tree
