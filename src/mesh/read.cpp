// The public border of reading: opens, chooses the format, turns refusals into errors.
#include "odds/mesh/read.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <string_view>

#include "mesh/byte_order_mark.hpp"
#include "mesh/byte_source.hpp"
#include "mesh/formats.hpp"
#include "mesh/refusal.hpp"

namespace odds::mesh {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::optional<Format> format_of_name(const std::string& name) {
  std::filesystem::path path = lower_case(name);
  if (path.extension() == ".gz") path = path.stem();
  const std::string extension = path.extension().string();
  if (extension == ".obj") return Format::obj;
  if (extension == ".stl") return Format::stl;
  if (extension == ".ply") return Format::ply;
  if (extension == ".off") return Format::off;
  return std::nullopt;
}

bool is_off_keyword(std::string_view word) {
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  }
  return word == "OFF";
}

/// Words that only OBJ files have among the first ones of a line.
bool is_obj_keyword(std::string_view word) {
  static constexpr std::string_view known[] = {"v", "vn", "vt", "f", "o", "g", "s", "l", "mtllib", "usemtl"};
  return std::find(std::begin(known), std::end(known), word) != std::end(known);
}

std::string_view first_word(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (!text.starts_with('#')) return text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
  }
}

bool has_size_of_binary_stl(Input& input, std::uint64_t largest_size) {
  constexpr std::size_t preamble_bytes = 84;
  if (!input.fill(preamble_bytes)) return false;
  const std::uint64_t triangles = Input::decode<std::uint32_t>(input.cursor() + 80, std::endian::little);
  const std::uint64_t implied = preamble_bytes + 50 * triangles;
  return implied <= largest_size && implied == input.size();
}

/// A binary STL file's header is free text, also if it begins with one.
void skip_byte_order_mark(Input& input, std::uint64_t largest_size) {
  if (!input.fill(byte_order_mark.size())) return;
  const std::string_view head(input.cursor(), input.available());
  if (!head.starts_with(byte_order_mark) || has_size_of_binary_stl(input, largest_size)) return;
  input.move_to(input.cursor() + byte_order_mark.size());
}

Format choose_format(Input& input, std::uint64_t largest_size) {
  input.fill(Input::largest_fill);
  const std::string_view head(input.cursor(), input.available());
  const std::string_view word = first_word(head);
  const std::optional<Format> named = format_of_name(input.name());
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return Format::ply;
  // A binary STL file's header is free text, even "OFF ...".
  if (has_size_of_binary_stl(input, largest_size)) return Format::stl;
  if (is_off_keyword(word)) return Format::off;
  if (named) return *named;
  if (lower_case(std::string(word.substr(0, 16))) == "solid") return Format::stl;
  if (is_obj_keyword(word)) return Format::obj;
  input.binary = head.find('\0') != std::string_view::npos;
  input.refuse("neither the name nor the content tells the format",
               "give a mesh in OBJ, STL, PLY or OFF (plain or .gz) with the extension of its format");
}

TriangleMesh parse(Format format, Input& input, MeshBuilder builder, std::uint64_t largest_size) {
  switch (format) {
    case Format::obj:
      return read_obj(input, std::move(builder));
    case Format::stl:
      return read_stl(input, std::move(builder), largest_size);
    case Format::ply:
      return read_ply(input, std::move(builder));
    case Format::off:
      break;
  }
  return read_off(input, std::move(builder));
}

TriangleMesh read_stored(const StoredBytes& stored, std::optional<Format> format, const std::string& name,
                         const ReadOptions& options) {
  if (!(options.scale > 0) || !std::isfinite(options.scale)) {
    throw Refusal{{name, "", "the scale " + std::to_string(options.scale) + " is not a positive number",
                   "give metres per unit of the file, such as 0.001 for millimetres"}};
  }
  if (stored.size() == 0) throw Refusal{{name, "byte 0", "the file is empty", "give a mesh file"}};
  if (stored.size() > options.max_file_bytes) {
    throw Refusal{{name, "byte " + std::to_string(options.max_file_bytes),
                   "the file has " + std::to_string(stored.size()) + " bytes, more than the limit",
                   "raise max_file_bytes if this is really a mesh"}};
  }
  const std::unique_ptr<ByteSource> source = stream(stored, name, options.max_unpacked_bytes);
  Input input(*source, name);
  const std::uint64_t largest_size = source->packed() ? options.max_unpacked_bytes : options.max_file_bytes;
  skip_byte_order_mark(input, largest_size);
  if (!format) format = choose_format(input, largest_size);
  return parse(*format, input, MeshBuilder(input, options, stored.size()), largest_size);
}

/// Runs `work` and makes what it throws an Error. `name` stands in the error for exhausted memory.
template <class Work>
Result<TriangleMesh> guarded(const std::string& name, Work work) {
  try {
    return work();
  } catch (Refusal& refusal) {
    return std::move(refusal.error);
  } catch (const std::bad_alloc&) {
    return Error{name, "", "not enough memory for the mesh", "free some memory or give a smaller mesh"};
  }
}

}  // namespace

Result<TriangleMesh> read(const std::filesystem::path& path, const ReadOptions& options) noexcept {
  return guarded(path.string(), [&] {
    const std::unique_ptr<StoredBytes> file = open_file(path);
    return read_stored(*file, std::nullopt, path.string(), options);
  });
}

Result<TriangleMesh> read_from_memory(std::span<const std::byte> bytes, std::optional<Format> format,
                                      const std::string& name, const ReadOptions& options) noexcept {
  return guarded(name, [&] { return read_stored(*view_memory(bytes), format, name, options); });
}

}  // namespace odds::mesh
