// Parsing and checking PLY headers.
#include "mesh/ply_header.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

namespace odds::mesh::ply {
namespace {

constexpr std::size_t most_properties = 1000;  // keeps a header's memory small whatever its length

std::optional<Scalar> scalar(std::string_view name) {
  using enum Scalar;
  static constexpr std::array<std::pair<std::string_view, Scalar>, 16> names = {{
      {"char", int8},
      {"uchar", uint8},
      {"short", int16},
      {"ushort", uint16},
      {"int", int32},
      {"uint", uint32},
      {"float", float32},
      {"double", float64},
      {"int8", int8},
      {"uint8", uint8},
      {"int16", int16},
      {"uint16", uint16},
      {"int32", int32},
      {"uint32", uint32},
      {"float32", float32},
      {"float64", float64},
  }};
  for (const auto& [known, type] : names) {
    if (known == name) return type;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(Input& input) : input_(input), text_(input, {}) {}

  Header read() {
    if (text_.word() != "ply") input_.refuse("a PLY file begins with the line 'ply'", "export the file again");
    text_.expect_line_end("'ply'");
    const bool lone_returns = *input_.cursor() == '\r' && input_.fill(2) && input_.cursor()[1] != '\n';
    for (;;) {
      if (!text_.next_line()) input_.refuse("the file ends inside the header", "the file is truncated: copy it again");
      const std::string_view keyword = text_.word();
      if (keyword == "end_header") break;
      statement(keyword);
    }
    end(lone_returns);
    check();
    return std::move(header_);
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format") {
      format();
    } else if (keyword == "element") {
      element();
    } else if (keyword == "property") {
      property();
    } else {
      input_.refuse(in_quotes(keyword) + " is not a keyword of a PLY header",
                    "write format, element, property, comment, obj_info or end_header");
    }
  }

  void format() {
    if (has_format_) input_.refuse("a second format line", "leave only one");
    const std::string_view name = text_.word();
    if (name == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = Encoding::little_endian;
    } else if (name == "binary_big_endian") {
      header_.encoding = Encoding::big_endian;
    } else {
      input_.refuse("the format " + in_quotes(name) + " is unknown",
                    "write ascii, binary_little_endian or binary_big_endian");
    }
    if (const std::string_view version = text_.word(); version != "1.0") {
      input_.refuse("the version of the format is " + in_quotes(version) + ", not 1.0", "export the file as PLY 1.0");
    }
    has_format_ = true;
  }

  void element() {
    Element element{.name = std::string(text_.word())};
    if (element.name.empty()) input_.refuse("an element has no name", "write 'element NAME COUNT'");
    const std::int64_t count = text_.integer(text_.word(), "the element's count");
    if (count < 0) input_.refuse("the count of " + in_quotes(element.name) + " is negative", "correct the count");
    element.count = static_cast<std::uint64_t>(count);
    text_.expect_line_end("the element's count");
    if (header_.find(element.name) != nullptr) {
      input_.refuse("the element " + in_quotes(element.name) + " is declared twice", "join the two");
    }
    count_declaration();
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) {
      input_.refuse("a property stands before the first element", "put it behind the element that it belongs to");
    }
    Property property;
    std::string_view word = text_.word();
    if (word == "list") {
      property.count_type = type(text_.word());
      if (!is_integer(*property.count_type)) {
        input_.refuse("the length of a list has a type that is not an integer", "declare it as uchar or int");
      }
      word = text_.word();
    }
    property.type = type(word);
    property.name = text_.word();
    if (property.name.empty()) input_.refuse("a property has no name", "write 'property TYPE NAME'");
    text_.expect_line_end("the property's name");
    Element& element = header_.elements.back();
    if (element.find(property.name)) {
      input_.refuse("the property " + in_quotes(property.name) + " is declared twice", "rename or remove one");
    }
    count_declaration();
    element.properties.push_back(std::move(property));
  }

  Scalar type(std::string_view name) {
    const std::optional<Scalar> found = scalar(name);
    if (!found) {
      input_.refuse("the type " + in_quotes(name) + " is unknown",
                    "write char, uchar, short, ushort, int, uint, float or double");
    }
    return *found;
  }

  void count_declaration() {
    if (++declarations_ > most_properties) {
      input_.refuse("the header declares more than 1000 elements and properties", "export the mesh without the extras");
    }
  }

  /// Binary data begins right behind the line end, which next_line() might misread: its first byte may be '\n'.
  void end(bool lone_returns) {
    text_.expect_line_end("'end_header'");
    input_.fill(2);
    const char* cursor = input_.cursor();
    if (cursor == input_.limit()) return;
    const bool pair = *cursor == '\r' && !lone_returns && cursor + 1 < input_.limit() && cursor[1] == '\n';
    input_.move_to(cursor + (pair ? 2 : 1));
  }

  void check() {
    if (!has_format_) input_.refuse("the header has no format line", "add 'format ascii 1.0' or what the data is");
    std::uint64_t needed = 0;
    const std::uint64_t there = input_.remaining();
    const std::uint64_t room = there + (header_.encoding == Encoding::ascii ? 1 : 0);  // a last line may lack its end
    for (const Element& element : header_.elements) {
      if (element.count == 0) continue;
      if (element.properties.empty()) {
        input_.refuse("the element " + in_quotes(element.name) + " has no property",
                      "declare its properties or remove it");
      }
      const std::uint64_t least = element.least_bytes(header_.encoding);
      const std::uint64_t left = room - needed;
      if (element.count > left / least) {
        input_.refuse("the header claims " + std::to_string(element.count) + " elements " + in_quotes(element.name) +
                          ", but only " + std::to_string(there) + " bytes follow it",
                      "correct the count; if it is right, the file is truncated");
      }
      needed += element.count * least;
    }
  }

  Input& input_;
  TextScanner text_;
  Header header_;
  bool has_format_ = false;
  std::size_t declarations_ = 0;
};

}  // namespace

std::size_t size_of(Scalar type) noexcept {
  static constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> Element::find(const std::string& property) const noexcept {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return i;
  }
  return std::nullopt;
}

std::uint64_t Element::least_bytes(Encoding encoding) const noexcept {
  std::uint64_t bytes = 0;
  for (const Property& property : properties) {
    constexpr std::uint64_t digit_and_separator = 2;
    bytes += encoding == Encoding::ascii ? digit_and_separator : size_of(property.count_type.value_or(property.type));
  }
  return bytes;
}

const Element* Header::find(const std::string& element) const noexcept {
  for (const Element& candidate : elements) {
    if (candidate.name == element) return &candidate;
  }
  return nullptr;
}

Header read_header(Input& input) { return HeaderReader(input).read(); }

}  // namespace odds::mesh::ply
