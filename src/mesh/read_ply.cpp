// PLY: vertices and faces in three encodings; other elements and properties are passed over.
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "mesh/formats.hpp"
#include "mesh/ply_header.hpp"

namespace odds::mesh {
namespace {

using ply::Element;
using ply::Encoding;
using ply::Property;
using ply::Scalar;

/// Values one after the other from lines of words; an element is a line.
class AsciiValues {
 public:
  explicit AsciiValues(Input& input) : input_(input), text_(input, {}) {}

  void begin_element(const Element& element) {
    first_ = text_.word_on_any_line();
    if (!first_.empty()) return;
    input_.refuse("the file ends before the last element " + in_quotes(element.name),
                  "the file is truncated or its counts are wrong: copy or export it again");
  }
  double real(Scalar) { return text_.number(word(), "a coordinate"); }
  std::int64_t integer(Scalar) { return text_.integer(word(), "an integer"); }
  void pass(Scalar, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (word().empty()) input_.refuse("a value is missing at the end of the line", "complete the line");
    }
  }
  void end_element() { text_.expect_line_end("the last value of an element"); }
  void end_input() {
    if (const std::string_view extra = text_.word_on_any_line(); !extra.empty()) {
      input_.refuse(in_quotes(extra) + " follows the last element",
                    "correct the counts in the header or remove the rest");
    }
  }

 private:
  /// begin_element() had to read the line's first word already.
  std::string_view word() { return first_.empty() ? text_.word() : std::exchange(first_, {}); }

  Input& input_;
  TextScanner text_;
  std::string_view first_;
};

/// Values one after the other from packed bytes.
class BinaryValues {
 public:
  BinaryValues(Input& input, Encoding encoding)
      : input_(input), order_(encoding == Encoding::big_endian ? std::endian::big : std::endian::little) {
    input.binary = true;
  }

  void begin_element(const Element&) noexcept { element_offset_ = input_.offset(); }
  double real(Scalar type) {
    double value = 0;
    if (type == Scalar::float64) {
      value = input_.take_number<double>(order_);
    } else if (type == Scalar::float32) {
      value = static_cast<double>(input_.take_number<float>(order_));
    } else {
      value = static_cast<double>(integer(type));
    }
    if (!std::isfinite(value)) {
      input_.refuse("a coordinate is not finite", "remove or correct the vertex where the file was made");
    }
    return value;
  }
  std::int64_t integer(Scalar type) {
    switch (type) {
      case Scalar::int8:
        return input_.take_number<std::int8_t>(order_);
      case Scalar::uint8:
        return input_.take_number<std::uint8_t>(order_);
      case Scalar::int16:
        return input_.take_number<std::int16_t>(order_);
      case Scalar::uint16:
        return input_.take_number<std::uint16_t>(order_);
      case Scalar::int32:
        return input_.take_number<std::int32_t>(order_);
      default:
        return input_.take_number<std::uint32_t>(order_);
    }
  }
  void pass(Scalar type, std::uint64_t count) { input_.skip(count * ply::size_of(type)); }
  void end_element() noexcept { input_.place_at(element_offset_); }
  void end_input() {
    if (!input_.fill(1)) return;
    input_.take(1);
    input_.refuse("bytes follow the last element", "correct the counts in the header or cut off the rest");
  }

 private:
  Input& input_;
  std::endian order_;
  std::uint64_t element_offset_ = 0;
};

/// The three coordinates' and the corner list's places among the properties.
struct Layout {
  std::array<std::size_t, 3> axes{};
  std::size_t corners = 0;
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

const Element& required(const Input& input, const ply::Header& header, const char* name) {
  const Element* const element = header.find(name);
  if (element == nullptr) {
    const bool strips = header.find("tristrips") != nullptr;
    input.refuse(std::string("the header declares no element ") + name,
                 strips ? "export faces instead of triangle strips" : "export the mesh with vertices and faces");
  }
  return *element;
}

Layout find_layout(const Input& input, const ply::Header& header) {
  Layout layout;
  const Element& vertex = required(input, header, "vertex");
  const Element& face = required(input, header, "face");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto property = vertex.find(name);
    if (!property || vertex.properties[*property].count_type) {
      input.refuse("the element vertex has no number " + name, "declare 'property float " + name + "'");
    }
    layout.axes[axis] = *property;
  }
  auto corners = face.find("vertex_indices");
  if (!corners) corners = face.find("vertex_index");
  if (!corners || !face.properties[*corners].count_type || !ply::is_integer(face.properties[*corners].type)) {
    input.refuse("the element face has no list of integers vertex_indices (or vertex_index)",
                 "declare 'property list uchar int vertex_indices'");
  }
  layout.corners = *corners;
  layout.vertices = vertex.count;
  layout.faces = face.count;
  return layout;
}

template <class Values>
class PlyReader {
 public:
  PlyReader(Input& input, MeshBuilder& builder, const Layout& layout, Values values)
      : input_(input), builder_(builder), layout_(layout), values_(values) {}

  void read(const ply::Header& header) {
    for (const Element& element : header.elements) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        values_.begin_element(element);
        if (element.name == "vertex") {
          vertex(element);
        } else if (element.name == "face") {
          face(element);
        } else {
          for (const Property& property : element.properties) pass(property);
          values_.end_element();
        }
      }
    }
    values_.end_input();
  }

 private:
  void vertex(const Element& element) {
    std::array<double, 3> position{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const auto axis = std::find(layout_.axes.begin(), layout_.axes.end(), p);
      if (axis == layout_.axes.end()) {
        pass(element.properties[p]);
      } else {
        position[static_cast<std::size_t>(axis - layout_.axes.begin())] = values_.real(element.properties[p].type);
      }
    }
    values_.end_element();
    builder_.add_vertex(position[0], position[1], position[2]);
  }

  void face(const Element& element) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (p == layout_.corners) {
        corners(element.properties[p]);
      } else {
        pass(element.properties[p]);
      }
    }
    values_.end_element();
  }

  void corners(const Property& property) {
    const std::uint64_t begin = input_.offset();
    const std::uint64_t count = length(property);
    builder_.begin_polygon();
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t index = values_.integer(property.type);
      if (index < 0 || static_cast<std::uint64_t>(index) >= layout_.vertices) {
        input_.refuse("vertex index " + std::to_string(index) + " is out of range (there are " +
                          std::to_string(layout_.vertices) + " vertices, counted from 0)",
                      "correct the face");
      }
      builder_.add_corner(static_cast<std::uint32_t>(index));
    }
    input_.place_at(begin);
    builder_.end_polygon();
  }

  void pass(const Property& property) { values_.pass(property.type, property.count_type ? length(property) : 1); }

  std::uint64_t length(const Property& list) {
    const std::int64_t count = values_.integer(*list.count_type);
    if (count < 0) input_.refuse("a list has the negative length " + std::to_string(count), "correct the length");
    return static_cast<std::uint64_t>(count);
  }

  Input& input_;
  MeshBuilder& builder_;
  Layout layout_;
  Values values_;
};

}  // namespace

TriangleMesh read_ply(Input& input, MeshBuilder builder) {
  const ply::Header header = ply::read_header(input);
  const Layout layout = find_layout(input, header);
  builder.reserve(layout.vertices, layout.faces);
  if (input.fill(1)) ++input.line;  // where no data follows, the last line keeps its number
  if (header.encoding == Encoding::ascii) {
    PlyReader(input, builder, layout, AsciiValues(input)).read(header);
  } else {
    PlyReader(input, builder, layout, BinaryValues(input, header.encoding)).read(header);
  }
  return std::move(builder).finish();
}

}  // namespace odds::mesh
