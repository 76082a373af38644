// Reading triangle meshes from OBJ, STL, PLY and OFF files, plain or packed with gzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "odds/math/error.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// The file formats that can be read. Ascii and binary variants are told apart by content.
enum class Format { obj, stl, ply, off };

/// Limits and units for reading. The defaults suit any mesh that a desktop computer can use.
struct ReadOptions {
  std::uint64_t max_file_bytes = std::uint64_t{4} << 30;      ///< a larger file (as stored) is refused unread
  std::uint64_t max_unpacked_bytes = std::uint64_t{4} << 30;  ///< gzip: unpacking stops with an error here
  std::uint64_t max_vertices = std::uint64_t{1} << 28;        ///< at most 2^30
  std::uint64_t max_triangles = std::uint64_t{1} << 28;       ///< at most 2^30; polygons count as their triangles
  double scale = 1;  ///< metres per unit of the file, finite and > 0; 0.001 for a file in millimetres
};

/// Reads the mesh in `path`. The format is chosen by content where that is unambiguous (PLY, OFF, ascii STL), else by
/// extension (.obj .stl .ply .off, each also with .gz; gzip itself is recognised by content), else by a closer look.
///
/// - OBJ: `v`, `f` (v, v/vt, v//vn, v/vt/vn, negative indices, forward references), line continuations. Free-form
///   geometry and `call` are refused; other statements and lines in front of the first vertex are ignored.
/// - STL: ascii (several solids allowed) and binary (recognised by its size even if its header begins with "solid").
///   Corners at exactly equal positions become one vertex, in order of first appearance; stored normals are ignored.
/// - PLY: ascii, binary little and big endian; extra elements and properties are skipped.
/// - OFF: also COFF, NOFF, STOFF and combinations.
///
/// Polygons are fanned from their first corner; where that fan folds, as of many that are not convex, they are cut so
/// that their triangles cover them and nothing else, for half a second of a file at most (tens of thousands of corners
/// in one). Nothing is repaired or dropped: non-finite or huge coordinates, indices out of range, polygons with fewer
/// than three corners, missing or surplus data are errors that name the line (text) or byte (binary). Numbers are
/// rounded correctly and do not depend on the locale.
///
/// Memory never exceeds 10 times the size of the file as stored (packed, if it is) + 64 MiB; a file that would need
/// more is refused. Counts that a header claims are compared with the bytes that follow before anything is allocated.
/// Thread-safe. Throws nothing.
Result<TriangleMesh> read(const std::filesystem::path& path, const ReadOptions& options = {}) noexcept;

/// The same for bytes in memory (they may be packed with gzip). `name` stands in error messages, and its extension
/// helps to choose the format if `format` is empty. The memory bound does not count `bytes` itself.
Result<TriangleMesh> read_from_memory(std::span<const std::byte> bytes, std::optional<Format> format,
                                      const std::string& name, const ReadOptions& options = {}) noexcept;

}  // namespace odds::mesh
