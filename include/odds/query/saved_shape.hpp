// Shapes in files: built once, ready in milliseconds ever after.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>

#include "odds/math/error.hpp"
#include "odds/query/shape.hpp"

namespace odds::query {

/// Writes a shape with everything in it, mesh, hierarchy and statistics, so that a loaded one answers with the same
/// bits. The file is there whole or not at all: it replaces one of that name only when it is complete. Allocates.
std::optional<Error> save_shape(const Shape& shape, const std::filesystem::path& path);

/// The same bytes into a stream; whether they were written is the stream's state.
void write_shape(const Shape& shape, std::ostream& out);

/// Maps the file into memory, where it stays while the shape lives: it must not be changed in place meanwhile
/// (`save_shape` never does, it replaces). Every byte is covered by a checksum, and every reference within the file is
/// looked at, by all processors: a file that is truncated, altered or too new gives an error that names the byte, and
/// no file, whoever made it, can make a query leave its memory, hang or yield a NaN. A checksum is no signature:
/// whoever writes a file with a right one chooses its answers. Files of the other byte order are read, too, into memory
/// of their own. Throws nothing but std::bad_alloc.
Result<std::shared_ptr<const Shape>> load_shape(const std::filesystem::path& path);

/// The same from memory, which is copied. `name` stands in errors.
Result<std::shared_ptr<const Shape>> load_shape(std::span<const std::byte> bytes, const std::string& name);

/// Whether a file begins like a saved shape; false too if it cannot be read.
[[nodiscard]] bool is_saved_shape(const std::filesystem::path& path) noexcept;

}  // namespace odds::query
