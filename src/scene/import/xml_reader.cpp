// Reading XML: size, syntax, places, numbers.
#include "scene/import/xml_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "mesh/trimmed.hpp"

namespace odds::scene {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{8} << 20;
constexpr double greatest_number = 1e12;
// Bodies and frames are named by the models around them too: long names in great number would fill the memory.
constexpr std::size_t longest_name = 256;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& place, const std::string& what,
                         const std::string& remedy) {
  throw ImportFailure{{path.string(), place, what, remedy}};
}

std::string read_whole(const std::filesystem::path& path) {
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) refuse(path, "", "cannot be read: " + code.message(), "check the path of the description");
  if (size > largest_file) refuse(path, "", "is larger than 8 MiB", "descriptions are small; check the path");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) refuse(path, "", "cannot be read", "check that it is a file and may be read");
  return text.str();
}

haptics::Place place_at(const std::vector<std::size_t>& line_ends, std::size_t offset) {
  const auto line = std::lower_bound(line_ends.begin(), line_ends.end(), offset);
  const std::size_t begin = line == line_ends.begin() ? 0 : *(line - 1) + 1;
  return {static_cast<std::uint32_t>(line - line_ends.begin() + 1), static_cast<std::uint32_t>(offset - begin + 1)};
}

// Whether xacro has still to go through it. Many a robot that it has made keeps its namespace, but no element or
// expression of it.
bool is_for_xacro(pugi::xml_node node, bool with_expressions) {
  if (std::string_view(node.name()).starts_with("xacro:")) return true;
  if (!with_expressions) return false;
  const auto attributes = node.attributes();
  return std::any_of(attributes.begin(), attributes.end(), [](pugi::xml_attribute attribute) {
    const std::string_view value = attribute.value();
    return value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos;
  });
}

}  // namespace

XmlReader::XmlReader(const std::filesystem::path& path) : path_(path), text_(read_whole(path)) {
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_ends_.push_back(i);
  }
  // The parser neither recurses nor expands entities of a DOCTYPE, which it skips: a bomb stays what it is.
  const pugi::xml_parse_result parsed =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, parsed.offset));
    refuse(path_, place_at(line_ends_, offset).text(), fmt::format("not valid XML: {}", parsed.description()),
           "correct the syntax at this place");
  }
  if (!root()) refuse(path_, "1:1", "has no element", "give a URDF or SDFormat description");
  const bool declared = text_.find("http://www.ros.org/wiki/xacro") != std::string::npos;
  const auto is_unfinished = [&](pugi::xml_node node) { return is_for_xacro(node, declared); };
  if (const pugi::xml_node unfinished = document_.find_node(is_unfinished)) {
    fail(unfinished, "is a xacro file, which a preprocessor makes a URDF from",
         "run it first: xacro FILE > robot.urdf");
  }
}

haptics::Place XmlReader::place_of(pugi::xml_node node) const {
  const std::ptrdiff_t offset = node.offset_debug();
  return offset < 0 ? haptics::Place{} : place_at(line_ends_, static_cast<std::size_t>(offset));
}

void XmlReader::fail(pugi::xml_node node, const std::string& what, const std::string& remedy) const {
  refuse(path_, place_of(node).text(), what, remedy);
}

std::string XmlReader::text(pugi::xml_node node, const char* attribute) const {
  const std::string value = node.attribute(attribute).value();
  if (value.empty()) {
    fail(node, fmt::format("<{}> lacks the attribute '{}'", node.name(), attribute),
         fmt::format("add {}=\"...\"", attribute));
  }
  return value;
}

std::string XmlReader::name(pugi::xml_node node, const std::string& scope) const {
  const std::string full = scope + text(node, "name");
  check_name(node, full);
  return full;
}

void XmlReader::check_name(pugi::xml_node node, std::string_view full) const {
  if (full.size() <= longest_name) return;
  fail(node,
       fmt::format("a name of {} bytes, those of the models around it included, beginning '{}'", full.size(),
                   full.substr(0, 40)),
       fmt::format("give at most {} bytes", longest_name));
}

pugi::xml_node XmlReader::child(pugi::xml_node node, const char* name) const {
  const pugi::xml_node found = node.child(name);
  if (!found) fail(node, fmt::format("<{}> lacks the element <{}>", node.name(), name), fmt::format("add <{}>", name));
  return found;
}

std::string XmlReader::child_text(pugi::xml_node node, const char* name) const { return text_of(child(node, name)); }

std::string XmlReader::text_of(pugi::xml_node node) { return std::string(mesh::trimmed(node.text().get())); }

bool XmlReader::flag(pugi::xml_node node, std::string_view text) const {
  std::string word(mesh::trimmed(text));
  std::transform(word.begin(), word.end(), word.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const bool yes = word == "true" || word == "1";
  if (!yes && word != "false" && word != "0" && !word.empty()) {
    fail(node, fmt::format("'{}' is neither true nor false", word.substr(0, 40)), "give true or false");
  }
  return yes;
}

Mat3 XmlReader::rotation_of_xyzw(pugi::xml_node node, const double* xyzw) const {
  const Quat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-3)) fail(node, "the quaternion is no rotation", "give x y z w, unit");
  return math::Pose::from_quaternion(Vec3::Zero(), q).rotation;
}

double XmlReader::number(pugi::xml_node node, std::string_view word, std::string_view what) const {
  const std::string_view digits = word.starts_with('+') && !word.starts_with("+-") ? word.substr(1) : word;
  const char* const end = digits.data() + digits.size();
  double number = 0.0;
  const auto [rest, status] = std::from_chars(digits.data(), end, number);
  if (status == std::errc::result_out_of_range && rest == end) {
    fail(node, fmt::format("{}: '{}' is too small or too large for a double", what, word.substr(0, 40)),
         "give a number of at most 1e12, and 0 for one below 1e-300");
  }
  if (status != std::errc{} || rest != end || !std::isfinite(number)) {
    fail(node, fmt::format("{}: '{}' is not a finite number", what, word.substr(0, 40)), "give a plain number");
  }
  return number;
}

std::vector<double> XmlReader::numbers(pugi::xml_node node, std::string_view text, std::size_t count,
                                       std::string_view what) const {
  std::vector<double> found;
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  for (std::size_t at = 0; at < text.size();) {
    if (blank(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !blank(text[end])) ++end;
    const double number = this->number(node, text.substr(at, end - at), what);
    if (std::abs(number) > greatest_number) {
      fail(node, fmt::format("{}: {} is beyond 1e12", what, number), "give a smaller number, in SI units");
    }
    found.push_back(number);
    if (found.size() > count) break;
    at = end;
  }
  if (found.size() != count) {
    fail(node,
         fmt::format("{} has {} numbers, not {}", what, found.size() > count ? "more" : std::to_string(found.size()),
                     count),
         fmt::format("give {} numbers", count));
  }
  return found;
}

double XmlReader::positive(pugi::xml_node node, std::string_view text, std::string_view what) const {
  const double value = numbers(node, text, 1, what).front();
  if (!(value > 0.0)) fail(node, fmt::format("{} is {}, not greater than 0", what, value), "give a positive number");
  return value;
}

Vec3 XmlReader::vector(pugi::xml_node node, std::string_view text, std::string_view what) const {
  const std::vector<double> v = numbers(node, text, 3, what);
  return {v[0], v[1], v[2]};
}

Vec3 XmlReader::positive_vector(pugi::xml_node node, std::string_view text, std::string_view what) const {
  const Vec3 v = vector(node, text, what);
  if (!(v.minCoeff() > 0.0)) fail(node, fmt::format("{} is not greater than 0", what), "give positive numbers");
  return v;
}

std::string XmlReader::nearest(std::string_view name, std::vector<std::string_view> candidates) {
  constexpr std::size_t longest = 100;  // the search takes the product of both lengths
  constexpr std::size_t most = 1000;
  if (name.size() > longest) return "";
  std::erase_if(candidates, [](std::string_view other) { return other.size() > longest; });
  if (candidates.size() > most) candidates.resize(most);
  return haptics::nearest_name(name, candidates);
}

Mat3 rotation_of_rpy(const Vec3& rpy_rad) {
  return (Eigen::AngleAxisd(rpy_rad.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy_rad.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(rpy_rad.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

}  // namespace odds::scene
