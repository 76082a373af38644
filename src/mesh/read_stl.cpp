// STL, ascii and binary. Triangles name positions only: equal positions are welded.
#include <algorithm>
#include <array>

#include "mesh/formats.hpp"
#include "mesh/text_scanner.hpp"

namespace odds::mesh {
namespace {

constexpr std::size_t header_bytes = 80;
constexpr std::size_t preamble_bytes = header_bytes + 4;
constexpr std::size_t facet_bytes = 50;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// STL keywords come in either case.
bool is(std::string_view word, std::string_view keyword) {
  if (word.size() != keyword.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (lower(word[i]) != keyword[i]) return false;
  }
  return true;
}

class AsciiStl {
 public:
  AsciiStl(Input& input, MeshBuilder& builder) : input_(input), builder_(builder), text_(input, {}) {}

  void read() {
    for (std::string_view word = text_.word_on_any_line(); !word.empty(); word = text_.word_on_any_line()) {
      if (!is(word, "solid")) refuse_word(word, "solid");
      text_.next_line();  // the rest is the solid's name
      solid();
    }
  }

 private:
  void solid() {
    for (;;) {
      const std::string_view word = text_.word_on_any_line();
      if (is(word, "endsolid")) break;
      if (!is(word, "facet")) refuse_word(word, "facet' or 'endsolid");
      facet();
    }
    text_.next_line();
  }

  void facet() {
    expect("normal");
    for (int i = 0; i < 3; ++i) {  // not used, and "nan" for degenerate triangles in many files
      const std::string_view word = text_.word_on_any_line();
      if (word.empty() || std::string_view("+-.0123456789nNiI").find(word.front()) == std::string_view::npos) {
        refuse_word(word, "three numbers of the normal");
      }
    }
    expect("outer");
    expect("loop");
    Triangle triangle;
    for (std::uint32_t& corner : triangle) {
      expect("vertex");
      std::array<double, 3> position;
      for (std::size_t axis = 0; axis < 3; ++axis) position[axis] = number();
      corner = builder_.weld_vertex(position[0], position[1], position[2]);
    }
    const std::string_view word = text_.word_on_any_line();
    if (is(word, "vertex")) {
      input_.refuse("a facet has more than 3 vertices", "export the surface as triangles");
    }
    if (!is(word, "endloop")) refuse_word(word, "endloop");
    expect("endfacet");
    builder_.add_triangle(triangle);
  }

  double number() {
    const std::string_view word = text_.word_on_any_line();
    if (word.empty()) refuse_word(word, "a coordinate");
    return text_.number(word, "a coordinate");
  }

  void expect(std::string_view keyword) {
    const std::string_view word = text_.word_on_any_line();
    if (!is(word, keyword)) refuse_word(word, keyword);
  }

  [[noreturn]] void refuse_word(std::string_view word, std::string_view expected) {
    const std::string wanted = "'" + std::string(expected) + "' is expected here, ";
    if (word.empty()) {
      input_.refuse(wanted + "but the file ends", "the file is truncated: copy or export it again");
    }
    input_.refuse(wanted + "not " + in_quotes(word), "correct the line or export the file again");
  }

  Input& input_;
  MeshBuilder& builder_;
  TextScanner text_;
};

/// Both variants may begin with "solid"; only the size that a binary header implies is sure. Of damaged files those
/// with control characters are taken for binary ones.
bool is_binary(Input& input, std::uint64_t largest_size) {
  constexpr std::size_t looked_at = 512;
  input.fill(looked_at);
  const std::string_view head(input.cursor(), std::min(input.available(), looked_at));
  if (head.size() >= preamble_bytes) {
    const std::uint64_t claim = Input::decode<std::uint32_t>(head.data() + header_bytes, std::endian::little);
    const std::uint64_t implied = preamble_bytes + claim * facet_bytes;
    if (implied <= largest_size && implied == input.size()) return true;
  }
  return std::any_of(head.begin(), head.end(), [](unsigned char c) { return c < ' ' && (c < '\t' || c > '\r'); });
}

void read_binary(Input& input, MeshBuilder& builder) {
  input.binary = true;
  input.take(header_bytes);
  const std::uint64_t count = input.take_number<std::uint32_t>(std::endian::little);
  const std::uint64_t needed = count * facet_bytes;
  const std::uint64_t there = input.remaining();
  if (needed > there) {
    input.refuse("the header claims " + std::to_string(count) + " triangles (" + std::to_string(needed) +
                     " bytes), but only " + std::to_string(there) + " bytes follow",
                 "the file is truncated or not STL: copy or export it again");
  }
  if (needed < there) {
    input.refuse("the header claims " + std::to_string(count) + " triangles (" + std::to_string(needed) +
                     " bytes), but " + std::to_string(there) + " bytes follow",
                 "correct the count or cut off what does not belong to the file");
  }
  builder.reserve(0, count);
  for (std::uint64_t i = 0; i < count; ++i) {
    input.take(12);  // normal
    Triangle triangle;
    for (std::uint32_t& corner : triangle) {
      const char* const bytes = input.take(12);
      const auto coordinate = [bytes](int axis) {
        return static_cast<double>(Input::decode<float>(bytes + 4 * axis, std::endian::little));
      };
      corner = builder.weld_vertex(coordinate(0), coordinate(1), coordinate(2));
    }
    input.take(2);  // attributes
    builder.add_triangle(triangle);
  }
}

}  // namespace

TriangleMesh read_stl(Input& input, MeshBuilder builder, std::uint64_t largest_size) {
  if (is_binary(input, largest_size)) {
    read_binary(input, builder);
  } else {
    AsciiStl(input, builder).read();
  }
  return std::move(builder).finish();
}

}  // namespace odds::mesh
