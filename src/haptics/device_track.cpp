// Reading and writing of device tracks as CSV.
#include "odds/haptics/device_track.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "mesh/byte_order_mark.hpp"
#include "mesh/output_file.hpp"
#include "mesh/trimmed.hpp"
#include "odds/haptics/settings.hpp"

namespace odds::haptics {
namespace {

constexpr double greatest_number = 1e12;  // as in scenes: differences of more over a nanosecond overflow

constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 30;  // three hours at 1 kHz need a tenth of it

enum Quantity : std::size_t { t, px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz, buttons, is_fresh, quantities };
constexpr std::array<std::string_view, quantities> quantity_names = {
    "t_ns",       "px_m",       "py_m",       "pz_m",         "qw",           "qx",           "qy",      "qz",
    "vx_m_per_s", "vy_m_per_s", "vz_m_per_s", "wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s", "buttons", "fresh"};

struct ColumnName {
  std::string_view name;
  Quantity quantity;
  double factor;  // to nanoseconds, metres
};
constexpr std::array<ColumnName, 22> column_names = {
    {{"t_ns", t, 1.0},          {"t_us", t, 1e3},          {"t_ms", t, 1e6},          {"t_s", t, 1e9},
     {"px_m", px, 1.0},         {"py_m", py, 1.0},         {"pz_m", pz, 1.0},         {"px_mm", px, 1e-3},
     {"py_mm", py, 1e-3},       {"pz_mm", pz, 1e-3},       {"qw", qw, 1.0},           {"qx", qx, 1.0},
     {"qy", qy, 1.0},           {"qz", qz, 1.0},           {"vx_m_per_s", vx, 1.0},   {"vy_m_per_s", vy, 1.0},
     {"vz_m_per_s", vz, 1.0},   {"wx_rad_per_s", wx, 1.0}, {"wy_rad_per_s", wy, 1.0}, {"wz_rad_per_s", wz, 1.0},
     {"buttons", buttons, 1.0}, {"fresh", is_fresh, 1.0}}};

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(mesh::trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

struct Columns {
  std::vector<ColumnName> of_cell;
  std::array<bool, quantities> present{};
};

Result<Columns> read_header(std::string_view line, const std::string& name, const std::string& place) {
  Columns columns;
  for (const std::string_view cell : split(line)) {
    const auto found =
        std::find_if(column_names.begin(), column_names.end(), [&](const ColumnName& c) { return c.name == cell; });
    if (found == column_names.end()) {
      std::array<std::string_view, column_names.size()> names;
      std::transform(column_names.begin(), column_names.end(), names.begin(),
                     [](const ColumnName& c) { return c.name; });
      const std::string near = nearest_name(cell, names);
      return Error{name, place, fmt::format("unknown column '{}'", cell),
                   near.empty() ? "valid are " + list_names(names)
                                : fmt::format("did you mean '{}'? columns carry their units", near)};
    }
    if (columns.present[found->quantity]) {
      return Error{name, place, fmt::format("a second column for what '{}' gives", cell), "keep one of them"};
    }
    columns.present[found->quantity] = true;
    columns.of_cell.push_back(*found);
  }
  for (std::size_t q = t; q <= qz; ++q) {
    if (!columns.present[q]) {
      return Error{name, place, fmt::format("the column '{}' is missing", quantity_names[q]),
                   "name the columns in the first line: t_ns,px_m,py_m,pz_m,qw,qx,qy,qz"};
    }
  }
  const auto velocities = std::count(columns.present.begin() + vx, columns.present.begin() + buttons, true);
  if (velocities != 0 && velocities != 6) {
    return Error{name, place, fmt::format("{} of the six velocity columns are there", velocities),
                 "give all of vx_m_per_s ... wz_rad_per_s, or none"};
  }
  return columns;
}

std::optional<Error> read_row(std::string_view line, const Columns& columns, const std::string& name,
                              const std::string& place, std::array<double, quantities>& values, std::int64_t& time_ns) {
  const std::vector<std::string_view> cells = split(line);
  if (cells.size() != columns.of_cell.size()) {
    return Error{name, place, fmt::format("{} values, but {} columns", cells.size(), columns.of_cell.size()),
                 "give one value per column"};
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const ColumnName& column = columns.of_cell[i];
    const char* const end = cells[i].data() + cells[i].size();
    if (column.quantity == t && column.factor == 1.0) {  // doubles lose nanoseconds after 104 days
      const auto [stop, code] = std::from_chars(cells[i].data(), end, time_ns);
      if (code != std::errc() || stop != end) {
        return Error{name, place, fmt::format("'{}' is not a whole number of nanoseconds", cells[i]),
                     "correct the value of t_ns"};
      }
      continue;
    }
    double value = 0.0;
    const auto [stop, code] = std::from_chars(cells[i].data(), end, value);
    if (code != std::errc() || stop != end || !std::isfinite(value)) {
      return Error{name, place, fmt::format("'{}' is not a finite number", cells[i]),
                   fmt::format("correct the value of {}", column.name)};
    }
    values[column.quantity] = value * column.factor;
    if (column.quantity != t && !(std::abs(values[column.quantity]) <= greatest_number)) {
      return Error{name, place, fmt::format("'{}' is beyond 1e12", cells[i]),
                   fmt::format("correct the value of {}, and check its unit", column.name)};
    }
    if (column.quantity == t) {
      if (!(std::abs(values[t]) < 9e18)) {
        return Error{name, place, fmt::format("the time {} is out of range", cells[i]),
                     "count from the recording's start"};
      }
      time_ns = std::llround(values[t]);
    }
    if (column.quantity == buttons && (value < 0.0 || value > 4294967295.0 || value != std::floor(value))) {
      return Error{name, place, fmt::format("'{}' is not a set of buttons", cells[i]),
                   "give a whole number from 0 to 4294967295"};
    }
    if (column.quantity == is_fresh && value != 0.0 && value != 1.0) {
      return Error{name, place, fmt::format("'{}' does not say whether the row is news", cells[i]), "give 1 or 0"};
    }
  }
  return std::nullopt;
}

Result<DeviceState> to_state(const std::array<double, quantities>& v, std::int64_t time_ns, const std::string& name,
                             const std::string& place) {
  DeviceState state;
  state.t_ns = time_ns;
  state.position_m = Vec3(v[px], v[py], v[pz]);
  state.orientation = Quat(v[qw], v[qx], v[qy], v[qz]);
  state.velocity_m_per_s = Vec3(v[vx], v[vy], v[vz]);
  state.angular_velocity_rad_per_s = Vec3(v[wx], v[wy], v[wz]);
  state.buttons = static_cast<std::uint32_t>(v[buttons]);
  state.fresh = v[is_fresh] != 0.0;
  if (!make_usable(state)) {  // no number is beyond: the quaternion
    return Error{name, place,
                 fmt::format("the quaternion has length {:.6g}, so it is not a rotation",
                             state.orientation.coeffs().stableNorm()),
                 "give a unit quaternion in qw, qx, qy, qz"};
  }
  return state;
}

// At a row, the mean of what leads to it and what leads on: for even times the central difference.
void differentiate(std::vector<DeviceState>& states) {
  const std::size_t last = states.size() - 1;
  for (std::size_t i = 0; i <= last && last > 0; ++i) {
    const Velocities to = velocities_between(states[i > 0 ? i - 1 : 0], states[i > 0 ? i : 1]);
    const Velocities on = velocities_between(states[std::min(i, last - 1)], states[std::min(i + 1, last)]);
    states[i].velocity_m_per_s = 0.5 * (to.linear_m_per_s + on.linear_m_per_s);
    states[i].angular_velocity_rad_per_s = 0.5 * (to.angular_rad_per_s + on.angular_rad_per_s);
  }
}

}  // namespace

Velocities velocities_between(const DeviceState& from, const DeviceState& to) noexcept {
  const double dt = 1e-9 * static_cast<double>(to.t_ns - from.t_ns);
  Quat turned = to.orientation * from.orientation.conjugate();
  if (turned.w() < 0.0) turned.coeffs() = -turned.coeffs();
  const Eigen::AngleAxisd rotation(turned);
  return {(to.position_m - from.position_m) / dt, rotation.axis() * (rotation.angle() / dt)};
}

Result<DeviceTrack> parse_track(std::string_view text, const std::string& name) {
  DeviceTrack track;
  std::optional<Columns> columns;
  std::size_t line_number = 0;
  text = mesh::without_byte_order_mark(text);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = mesh::trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    const std::string place = std::to_string(line_number);
    if (!columns) {
      Result<Columns> header = read_header(line, name, place);
      if (!header) return header.error();
      columns = std::move(header).value();
      continue;
    }
    std::array<double, quantities> values{};
    values[is_fresh] = 1.0;  // of a track that does not say
    std::int64_t time_ns = 0;
    if (auto error = read_row(line, *columns, name, place, values, time_ns)) return *error;
    Result<DeviceState> state = to_state(values, time_ns, name, place);
    if (!state) return state.error();
    if (!track.states.empty() && time_ns <= track.states.back().t_ns) {
      return Error{name, place, "the time is not later than that of the row before",
                   "sort the rows by time and leave out repeated times"};
    }
    track.states.push_back(state.value());
  }
  if (!columns)
    return Error{name, "", "the file holds no line of column names", "begin it with t_ns,px_m,py_m,pz_m,qw,qx,qy,qz"};
  if (track.states.empty())
    return Error{name, std::to_string(line_number), "no row follows the column names", "give at least one pose"};
  const std::int64_t start_ns = track.states.front().t_ns;
  if (start_ns < 0 && track.states.back().t_ns > std::numeric_limits<std::int64_t>::max() + start_ns) {
    return Error{name, std::to_string(line_number), "the times span more than 292 years", "check the unit of time"};
  }
  for (DeviceState& state : track.states) state.t_ns -= start_ns;
  track.gives_velocities = columns->present[vx];
  if (!track.gives_velocities) differentiate(track.states);
  return track;
}

Result<DeviceTrack> read_track(const std::filesystem::path& path) {
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) return Error{path.string(), "", "cannot be read: " + code.message(), "check the path of the track"};
  if (size > largest_file) return Error{path.string(), "", "is larger than 1 GiB", "split the track"};
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) return Error{path.string(), "", "cannot be read", "check that it is a file and may be read"};
  return parse_track(text.str(), path.string());
}

std::optional<Error> write_track(const std::filesystem::path& path, const DeviceTrack& track) {
  Result<mesh::OutputFile> opened = mesh::OutputFile::open(path);
  if (!opened) return opened.error();
  mesh::OutputFile& file = opened.value();
  for (std::size_t q = 0; q < quantities; ++q) file.write(fmt::format("{}{}", q > 0 ? "," : "", quantity_names[q]));
  file.write("\n");
  for (const DeviceState& s : track.states) {
    const Vec3& p = s.position_m;
    const Quat& q = s.orientation;
    const Vec3& v = s.velocity_m_per_s;
    const Vec3& w = s.angular_velocity_rad_per_s;
    // {} of fmt is the shortest text that reads back to the same bits.
    file.write(fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", s.t_ns, p.x(), p.y(), p.z(), q.w(),
                           q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), s.buttons, s.fresh ? 1 : 0));
  }
  return file.commit();
}

}  // namespace odds::haptics
