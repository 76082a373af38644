// Wavefront OBJ: vertices and faces; everything that carries no surface is passed over.
#include <algorithm>
#include <charconv>
#include <limits>

#include "mesh/formats.hpp"
#include "mesh/text_scanner.hpp"

namespace odds::mesh {
namespace {

class ObjReader {
 public:
  ObjReader(Input& input, MeshBuilder& builder)
      : input_(input), builder_(builder), text_(input, {.hash_comments = true, .continuations = true}) {}

  void read() {
    do {
      const std::string_view keyword = text_.word();
      if (keyword.empty()) continue;
      if (keyword == "v") {
        vertex();
      } else if (keyword == "f" || keyword == "fo") {
        face();
      } else {
        pass_over(keyword);
      }
    } while (text_.next_line());
    if (farthest_index_ > builder_.vertex_count()) refuse_index(farthest_line_, farthest_index_);
  }

  [[nodiscard]] std::string hint() const {
    if (lines_ > 0) return "it has " + std::to_string(lines_) + " line elements, which bound no surface";
    if (builder_.vertex_count() > 0) return "it has " + std::to_string(builder_.vertex_count()) + " vertices";
    return "";
  }

 private:
  void vertex() {
    const double x = text_.number(text_.word(), "coordinate x");
    const double y = text_.number(text_.word(), "coordinate y");
    const double z = text_.number(text_.word(), "coordinate z");
    builder_.add_vertex(x, y, z);
    // A weight (for curves only) or a colour may follow.
    if (text_.skip_numbers() > 4) {
      input_.refuse("a vertex has more than 7 numbers", "give three coordinates and at most four colour values");
    }
  }

  void face() {
    builder_.begin_polygon();
    for (std::string_view corner = text_.word(); !corner.empty(); corner = text_.word())
      builder_.add_corner(index(corner));
    builder_.end_polygon();
  }

  /// "v", "v/vt", "v//vn" or "v/vt/vn"; only v matters here.
  std::uint32_t index(std::string_view corner) {
    std::int64_t given = 0;
    const char* const end = corner.data() + corner.size();
    const auto [after, status] = std::from_chars(corner.data(), end, given);
    if (status == std::errc::invalid_argument || (after != end && !is_attribute({after, end}))) {
      input_.refuse("the corner " + in_quotes(corner) + " is not v, v/vt, v//vn or v/vt/vn with whole numbers",
                    "correct the face");
    }
    const std::uint64_t count = builder_.vertex_count();
    if (given < 0 && status == std::errc{} && static_cast<std::uint64_t>(-(given + 1)) < count) {
      return static_cast<std::uint32_t>(count - static_cast<std::uint64_t>(-(given + 1)) - 1);
    }
    constexpr std::int64_t largest = std::numeric_limits<std::uint32_t>::max();
    if (given < 0 || status != std::errc{} || given > largest) refuse_index(input_.line, corner);
    if (given == 0) input_.refuse("a face refers to vertex 0", "count vertices from 1 (or backwards from -1)");
    if (static_cast<std::uint64_t>(given) > std::max(count, farthest_index_)) {
      farthest_index_ = static_cast<std::uint64_t>(given);  // its vertex may still come
      farthest_line_ = input_.line;
    }
    return static_cast<std::uint32_t>(given - 1);
  }

  /// What follows the vertex index: "/vt", "//vn" or "/vt/vn", integers (some exporters leave them out) of any range.
  static bool is_attribute(std::string_view text) {
    if (text.front() != '/' || std::count(text.begin(), text.end(), '/') > 2) return false;
    for (std::size_t i = 1; i < text.size(); ++i) {
      const bool sign = text[i] == '-' && text[i - 1] == '/' && i + 1 < text.size();
      if (!sign && text[i] != '/' && (text[i] < '0' || text[i] > '9')) return false;
    }
    return true;
  }

  [[noreturn]] void refuse_index(std::uint64_t line, std::string_view corner) {
    input_.refuse_at(std::to_string(line),
                     "vertex index " + in_quotes(corner) + " is out of range (there are " +
                         std::to_string(builder_.vertex_count()) + " vertices" +
                         (corner.front() == '-' ? " before it)" : ")"),
                     "correct the face or add the missing vertices");
  }
  [[noreturn]] void refuse_index(std::uint64_t line, std::uint64_t index) { refuse_index(line, std::to_string(index)); }

  void pass_over(std::string_view keyword) {
    if (keyword == "surf" || keyword == "curv" || keyword == "call" || keyword == "csh") {
      input_.refuse("the statement " + in_quotes(keyword) + " (free-form geometry or another file) cannot be read",
                    "export the surface as polygons into one file");
    }
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const char first = keyword.front();
    const bool begun = builder_.vertex_count() > 0 || farthest_index_ > 0;
    const bool glued = std::string_view("vfVF").find(first) != std::string_view::npos &&
                       (keyword.size() == 1 || !is_letter(keyword[1]));
    if (glued || (begun && !is_letter(first))) {  // passing over it might lose a vertex or a face
      input_.refuse(in_quotes(keyword) + " does not begin a statement of OBJ",
                    "write 'v ' or 'f ' in front of vertices and faces, '#' in front of comments");
    }
    if (keyword == "l") ++lines_;
  }

  Input& input_;
  MeshBuilder& builder_;
  TextScanner text_;
  std::uint64_t farthest_index_ = 0;  // greatest index so far that no vertex had when it was read
  std::uint64_t farthest_line_ = 0;
  std::uint64_t lines_ = 0;
};

}  // namespace

TriangleMesh read_obj(Input& input, MeshBuilder builder) {
  ObjReader reader(input, builder);
  reader.read();
  return std::move(builder).finish(reader.hint());
}

}  // namespace odds::mesh
