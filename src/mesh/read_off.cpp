// OFF of Geomview (ascii, three-dimensional), with colours, normals and texture coordinates passed over.
#include <optional>

#include "mesh/formats.hpp"
#include "mesh/text_scanner.hpp"

namespace odds::mesh {
namespace {

class OffReader {
 public:
  OffReader(Input& input, MeshBuilder& builder)
      : input_(input), builder_(builder), text_(input, {.hash_comments = true, .continuations = false}) {}

  void read() {
    keyword();
    counts();
    for (std::uint64_t i = 0; i < vertices_; ++i) vertex(i);
    for (std::uint64_t i = 0; i < faces_; ++i) face(i);
    const std::string_view extra = next_item();
    if (!extra.empty()) {
      input_.refuse(in_quotes(extra) + " follows the last of " + std::to_string(faces_) + " faces",
                    "correct the counts at the beginning or remove the surplus lines");
    }
  }

 private:
  /// [ST][C][N]OFF; some files glue the vertex count to it.
  void keyword() {
    const std::string_view word = text_.word_on_any_line();
    std::string_view rest = word;
    const auto strip = [&rest](std::string_view prefix) {
      if (!rest.starts_with(prefix)) return false;
      rest.remove_prefix(prefix.size());
      return true;
    };
    if (strip("ST")) least_extras_ += 2;
    colours_ = strip("C");
    if (colours_) least_extras_ += 1;
    if (strip("N")) least_extras_ += 3;
    if (rest.starts_with("4OFF") || rest.starts_with("nOFF") || rest.starts_with("4nOFF")) {
      input_.refuse(in_quotes(word) + " announces vertices that are not three-dimensional", "export plain OFF");
    }
    if (!strip("OFF")) {
      input_.refuse("an OFF file begins with OFF, COFF, NOFF or the like, not with " + in_quotes(word),
                    "add the line OFF at the beginning if this is such a file");
    }
    if (!rest.empty()) glued_count_ = text_.integer(rest, "the vertex count");
  }

  void counts() {
    std::int64_t vertices = 0;
    if (glued_count_) {
      vertices = *glued_count_;
    } else {
      const std::string_view word = next_item();
      if (word == "BINARY") input_.refuse("binary OFF cannot be read", "export it as ascii OFF or PLY");
      vertices = text_.integer(word, "the vertex count");
    }
    const std::int64_t faces = text_.integer(text_.word(), "the face count");
    if (const std::string_view edges = text_.word(); !edges.empty()) text_.integer(edges, "the edge count");
    text_.expect_line_end("the counts");
    if (vertices < 0 || faces < 0) input_.refuse("a count is negative", "correct the counts of vertices and faces");
    vertices_ = static_cast<std::uint64_t>(vertices);
    faces_ = static_cast<std::uint64_t>(faces);
    builder_.check_limits(vertices_, faces_);
    constexpr std::uint64_t shortest_vertex = 6;  // "0 0 0\n"
    constexpr std::uint64_t shortest_face = 8;    // "3 0 0 0\n"
    const std::uint64_t there = input_.remaining();
    if (vertices_ * shortest_vertex + faces_ * shortest_face > there + 1) {
      input_.refuse("the header claims " + std::to_string(vertices_) + " vertices and " + std::to_string(faces_) +
                        " faces, but only " + std::to_string(there) + " bytes follow",
                    "correct the counts; if they are right, the file is truncated");
    }
    builder_.reserve(vertices_, faces_);
  }

  void vertex(std::uint64_t number) {
    const std::string_view word = next_item();
    if (word.empty()) refuse_end("vertices", number, vertices_);
    const double x = text_.number(word, "coordinate x");
    const double y = text_.number(text_.word(), "coordinate y");
    const double z = text_.number(text_.word(), "coordinate z");
    builder_.add_vertex(x, y, z);
    const std::size_t extras = text_.skip_numbers();
    // Colours of three or four values are common in files that do not announce them.
    const bool good = least_extras_ > 0 ? extras >= least_extras_ && extras <= least_extras_ + (colours_ ? 3 : 0)
                                        : extras == 0 || extras == 3 || extras == 4;
    if (!good) {
      input_.refuse(
          "a vertex line has " + std::to_string(3 + extras) + " numbers, which its file's kind does not allow",
          "put each vertex on a line of its own: x y z and what the first line of the file announces");
    }
  }

  void face(std::uint64_t number) {
    const std::string_view word = next_item();
    if (word.empty()) refuse_end("faces", number, faces_);
    const std::int64_t corners = text_.integer(word, "the number of corners");
    builder_.begin_polygon();
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t index = text_.integer(text_.word(), "a vertex index");
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
        input_.refuse("vertex index " + std::to_string(index) + " is out of range (there are " +
                          std::to_string(vertices_) + " vertices, counted from 0)",
                      "correct the face");
      }
      builder_.add_corner(static_cast<std::uint32_t>(index));
    }
    builder_.end_polygon();
    if (text_.skip_numbers() > 4) {
      input_.refuse("more than four colour values follow a face of " + std::to_string(corners) + " corners",
                    "put each face on a line of its own and correct its number of corners");
    }
  }

  /// The first word of the next line that has one.
  std::string_view next_item() { return text_.word_on_any_line(); }

  [[noreturn]] void refuse_end(const char* what, std::uint64_t found, std::uint64_t claimed) {
    input_.refuse("the file ends after " + std::to_string(found) + " of " + std::to_string(claimed) + " " + what,
                  "the file is truncated or its counts are wrong: copy or export it again");
  }

  Input& input_;
  MeshBuilder& builder_;
  TextScanner text_;
  std::optional<std::int64_t> glued_count_;
  std::size_t least_extras_ = 0;
  bool colours_ = false;
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
};

}  // namespace

TriangleMesh read_off(Input& input, MeshBuilder builder) {
  OffReader(input, builder).read();
  return std::move(builder).finish();
}

}  // namespace odds::mesh
