#include "tool/served_ticks.hpp"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "mesh/byte_order_mark.hpp"
#include "tool/one_line.hpp"

namespace odds::tool {

Result<std::vector<std::uint64_t>> read_served_ticks(const std::string& path) {
  constexpr const char* remedy = "give the ticks.csv that odds run wrote";
  constexpr std::size_t longest_line = 4096;
  std::error_code unknown;
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path, unknown)) return Error{path, "", "cannot be read", remedy};
  std::vector<std::uint64_t> ticks;
  char line[longest_line];
  for (std::size_t number = 1; file.getline(line, longest_line) || file.gcount() > 0; ++number) {
    const std::string_view text = number == 1 ? mesh::without_byte_order_mark(line) : line;
    const auto fault = [&](const std::string& what) { return Error{path, std::to_string(number), what, remedy}; };
    if (file.fail()) return fault("the line is too long");
    if (number == 1) {
      if (!text.starts_with("tick,")) return fault("the first column is not 'tick'");
      continue;
    }
    std::uint64_t tick = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), tick);
    if (parsed.ec != std::errc{} || *parsed.ptr != ',') {
      return fault(tool::quoted(on_one_line(text.substr(0, text.find(',')))) + " is not the number of a tick");
    }
    if (!ticks.empty() && tick <= ticks.back()) return fault("ticks must ascend");
    ticks.push_back(tick);
  }
  if (ticks.empty()) return Error{path, "", "there is no tick in it", remedy};
  return ticks;
}

}  // namespace odds::tool
