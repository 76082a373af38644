#include "tool/poses_csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "mesh/byte_order_mark.hpp"
#include "tool/one_line.hpp"

namespace odds::tool {
namespace {

constexpr std::array<std::string_view, 7> columns = {"x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr std::size_t longest_line = std::size_t{1} << 20;  // so that no file, however made, fills the memory
constexpr double largest_position = 1e15;                   // metres; as for meshes

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Splits at commas that are not inside quotes; quotes around a whole field are taken off.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    std::string_view field = trimmed(line.substr(begin, i - begin));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') {
      field = trimmed(field.substr(1, field.size() - 2));
    }
    fields.push_back(field);
    begin = i + 1;
  }
  return fields;
}

class Reader {
 public:
  explicit Reader(std::string name) : name_(std::move(name)) {}

  Result<std::vector<math::Pose>> read(std::istream& stream) {
    std::vector<char> buffer(longest_line + 2);  // a delimiter is read, too, and a terminator written
    while (stream.getline(buffer.data(), static_cast<std::streamsize>(buffer.size())) || stream.gcount() > 0) {
      ++line_number_;
      if (stream.fail()) {
        return fault("the line is longer than " + std::to_string(longest_line) + " bytes",
                     "give a CSV file with one row for each pose");
      }
      const auto taken = static_cast<std::size_t>(stream.gcount());
      std::string_view text(buffer.data(), stream.eof() ? taken : taken - 1);
      if (line_number_ == 1) text = mesh::without_byte_order_mark(text);
      if (text.ends_with('\r')) text.remove_suffix(1);
      if (trimmed(text).empty() || text.starts_with('#')) continue;
      const std::vector<std::string_view> fields = split(text);
      if (auto error = width_ == 0 ? take_header(fields) : take_row(fields)) return *std::move(error);
    }
    if (stream.bad()) return Error{name_, "", "reading failed", "check the file and its device"};
    if (width_ == 0) return Error{name_, "", "the file is empty", "begin it with a header: x,y,z,qw,qx,qy,qz"};
    if (poses_.empty()) return Error{name_, "", "there is no pose after the header", "add a row for each pose"};
    return std::move(poses_);
  }

 private:
  Error fault(std::string what, std::string remedy) const {
    return {name_, std::to_string(line_number_), std::move(what), std::move(remedy)};
  }

  std::optional<Error> take_header(const std::vector<std::string_view>& fields) {
    std::string missing;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto found = std::find(fields.begin(), fields.end(), columns[k]);
      if (found == fields.end()) {
        missing += (missing.empty() ? "" : ", ") + std::string(columns[k]);
        continue;
      }
      if (std::find(found + 1, fields.end(), columns[k]) != fields.end()) {
        return fault("column " + std::string(columns[k]) + " stands twice in the header", "keep one of the two");
      }
      place_[k] = static_cast<std::size_t>(found - fields.begin());
    }
    if (!missing.empty()) {
      return fault("the header lacks " + missing,
                   "name the columns x,y,z,qw,qx,qy,qz (metres; quaternion of B in A's frame)");
    }
    width_ = fields.size();
    return std::nullopt;
  }

  std::optional<Error> take_row(const std::vector<std::string_view>& fields) {
    if (fields.size() != width_) {
      return fault("this row has " + std::to_string(fields.size()) + " fields and the header " + std::to_string(width_),
                   "give one field for each column");
    }
    std::array<double, 7> values{};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::string_view field = fields[place_[k]];
      const auto end = std::from_chars(field.data(), field.data() + field.size(), values[k]);
      const bool read = end.ec == std::errc{} && end.ptr == field.data() + field.size() && std::isfinite(values[k]);
      if (!read || std::abs(values[k]) > largest_position) {
        return fault(std::string(columns[k]) + " = " + quoted(field) + " is not a number that can be used",
                     "give a plain decimal number of magnitude up to 1e15");
      }
    }
    const double largest = std::abs(*std::max_element(values.begin() + 3, values.end(),
                                                      [](double a, double b) { return std::abs(a) < std::abs(b); }));
    if (largest == 0.0) {
      return fault("the quaternion is zero, so it gives no rotation", "give qw,qx,qy,qz = 1,0,0,0 for none");
    }
    // Divided by the largest first, so that squares neither overflow nor vanish.
    const Quat rotation(values[3] / largest, values[4] / largest, values[5] / largest, values[6] / largest);
    poses_.push_back(math::Pose::from_quaternion({values[0], values[1], values[2]}, rotation));
    return std::nullopt;
  }

  std::string name_;
  std::size_t line_number_ = 0;
  std::size_t width_ = 0;  ///< columns of the header; 0 before it
  std::array<std::size_t, 7> place_{};
  std::vector<math::Pose> poses_;
};

}  // namespace

Result<std::vector<math::Pose>> read_poses(std::istream& stream, const std::string& name) {
  return Reader(name).read(stream);
}

Result<std::vector<math::Pose>> read_poses(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) return Error{path, "", "is a directory", "name a CSV file"};
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{path, "", "cannot be opened", "check the name and the permissions"};
  return read_poses(stream, path);
}

}  // namespace odds::tool
