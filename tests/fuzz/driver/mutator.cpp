// The ways in which an input is damaged.
#include "mutator.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace odds::fuzz {
namespace {

constexpr std::array<std::string_view, 34> numbers = {"0",
                                                      "1",
                                                      "2",
                                                      "3",
                                                      "4",
                                                      "-1",
                                                      "-2",
                                                      "-0",
                                                      "255",
                                                      "256",
                                                      "65535",
                                                      "65536",
                                                      "2147483647",
                                                      "2147483648",
                                                      "-2147483648",
                                                      "4294967295",
                                                      "4294967296",
                                                      "9223372036854775807",
                                                      "18446744073709551616",
                                                      "1e15",
                                                      "1.0000000001e15",
                                                      "-1e308",
                                                      "1e309",
                                                      "1e-400",
                                                      "nan",
                                                      "-inf",
                                                      "0x10",
                                                      "1,5",
                                                      "1e",
                                                      ".",
                                                      "+",
                                                      "--1",
                                                      "",
                                                      "000000000000000001"};

constexpr std::array<std::string_view, 62> words = {"v ",
                                                    "f ",
                                                    "\nv 1 2 3\n",
                                                    "\nf 1 2 3\n",
                                                    "f -1 -1 -1\n",
                                                    "1/1/1",
                                                    "1//1",
                                                    "//",
                                                    "\\\n",
                                                    "\\\r\n",
                                                    "\\",
                                                    "#",
                                                    "# ",
                                                    "surf",
                                                    "call x",
                                                    "fo ",
                                                    "vt ",
                                                    "l 1 2\n",
                                                    "g\n",
                                                    "solid ",
                                                    "endsolid",
                                                    "facet normal 0 0 0\n",
                                                    "outer loop\n",
                                                    "vertex 0 0 0\n",
                                                    "endloop\n",
                                                    "endfacet\n",
                                                    "SOLID",
                                                    "OFF",
                                                    "COFF\n",
                                                    "NOFF\n",
                                                    "STOFF",
                                                    "4OFF",
                                                    "nOFF",
                                                    "BINARY",
                                                    "ply\n",
                                                    "format ascii 1.0\n",
                                                    "format binary_little_endian 1.0\n",
                                                    "format binary_big_endian 1.0\n",
                                                    "element vertex 3\n",
                                                    "element face 1\n",
                                                    "element vertex 4000000000\n",
                                                    "element face 4294967296\n",
                                                    "element x 1\n",
                                                    "property float x\n",
                                                    "property double y\n",
                                                    "property uchar z\n",
                                                    "property list uchar int vertex_indices\n",
                                                    "property list int double a\n",
                                                    "property list uint uint8 vertex_index\n",
                                                    "comment ",
                                                    "obj_info ",
                                                    "end_header\n",
                                                    "3 0 1 2\n",
                                                    "4 0 1 2 3\n",
                                                    "0 0 0\n",
                                                    " ",
                                                    "\n",
                                                    "\r",
                                                    "\r\n",
                                                    "\t",
                                                    "\v",
                                                    "\f"};

bool is_number_part(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e'; }

template <class T>
void put(std::string& text, std::size_t at, T value, bool swapped) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof value);
  if (swapped) std::reverse(raw.begin(), raw.end());
  for (std::size_t i = 0; i < raw.size() && at + i < text.size(); ++i) text[at + i] = raw[i];
}

}  // namespace

Mutator::Mutator(std::uint64_t seed) : seeds_(seeds()), seed_(seed) {}

Input Mutator::input(std::uint64_t n) {
  random_ = math::Random(seed_, n);
  Input input;
  if (one_in(20)) {
    input.content = from_nothing();
  } else {
    const Seed& seed = seeds_[below(seeds_.size())];
    input = {seed.content, seed.format};
  }
  for (std::uint64_t changes = below(6); changes > 0; --changes) mutate(input.content);
  if (one_in(12)) {
    input.content = packed(input.content);
    if (one_in(2)) change_bytes(input.content);
    if (one_in(4)) change_range(input.content);
    if (one_in(8)) input.content += input.content;
  }
  return input;
}

void Mutator::mutate(std::string& text) {
  switch (below(8)) {
    case 0:
      return change_bytes(text);
    case 1:
      return change_range(text);
    case 2:
    case 3:
      return change_number(text);
    case 4:
      return change_binary_number(text);
    case 5:
      return change_lines(text);
    case 6:
      return insert_word(text);
    default:
      return splice(text);
  }
}

void Mutator::change_bytes(std::string& text) {
  if (text.empty()) return;
  for (std::uint64_t changes = 1 + below(4); changes > 0; --changes) {
    char& c = text[below(text.size())];
    c = one_in(2) ? static_cast<char>(c ^ (1 << below(8))) : static_cast<char>(below(256));
  }
}

void Mutator::change_range(std::string& text) {
  const std::size_t begin = below(text.size() + 1);
  const std::size_t size = below(std::min<std::size_t>(text.size() - begin, 64) + 1);
  switch (below(4)) {
    case 0:
      text.erase(begin, size);
      break;
    case 1:
      text.resize(begin);
      break;
    case 2:
      text.insert(below(text.size() + 1), text.substr(begin, size));
      break;
    default:
      text.insert(begin, std::string(below(200), static_cast<char>(below(256))));
      break;
  }
}

void Mutator::change_number(std::string& text) {
  if (text.empty()) return;
  std::size_t begin = below(text.size());
  while (begin < text.size() && !is_number_part(text[begin])) ++begin;
  while (begin > 0 && is_number_part(text[begin - 1])) --begin;
  std::size_t end = begin;
  while (end < text.size() && is_number_part(text[end])) ++end;
  const std::string number =
      one_in(3) ? std::to_string(below(one_in(2) ? 16 : 1000)) : std::string(numbers[below(numbers.size())]);
  text.replace(begin, end - begin, number);
}

void Mutator::change_binary_number(std::string& text) {
  if (text.empty()) return;
  constexpr std::array<std::uint32_t, 9> whole = {0, 1, 2, 3, 0x7f, 0xff, 0x7fffffff, 0x80000000, 0xffffffff};
  constexpr std::array<float, 5> real = {std::numeric_limits<float>::quiet_NaN(),
                                         std::numeric_limits<float>::infinity(), 1e16f, -0.f, 1e-45f};
  // Counts and the beginning of data are more interesting than the rest.
  const std::size_t header_end = text.find("end_header");
  std::size_t at = below(text.size());
  if (one_in(4)) at = header_end == std::string::npos ? 80 : header_end + 11 + below(16);
  const bool swapped = one_in(2);
  switch (below(5)) {
    case 0:
      return put(text, at, static_cast<std::uint8_t>(whole[below(whole.size())]), swapped);
    case 1:
      return put(text, at, static_cast<std::uint16_t>(whole[below(whole.size())]), swapped);
    case 2:
      return put(text, at, whole[below(whole.size())], swapped);
    case 3:
      return put(text, at, real[below(real.size())], swapped);
    default:
      return put(text, at, static_cast<double>(real[below(real.size())]), swapped);
  }
}

void Mutator::change_lines(std::string& text) {
  const auto line = [&]() -> std::pair<std::size_t, std::size_t> {
    const std::size_t middle = below(text.size() + 1);
    const std::size_t before = middle == 0 ? std::string::npos : text.rfind('\n', middle - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::size_t after = text.find('\n', begin);
    return {begin, (after == std::string::npos ? text.size() : after + 1) - begin};
  };
  const auto [begin, size] = line();
  const std::string copy = text.substr(begin, size);
  if (one_in(3)) {
    text.erase(begin, size);
  } else if (one_in(2)) {
    text.insert(line().first, copy);
  } else {
    text.erase(begin, size);
    text.insert(line().first, copy);
  }
}

void Mutator::insert_word(std::string& text) { text.insert(below(text.size() + 1), words[below(words.size())]); }

void Mutator::splice(std::string& text) {
  const std::string& other = seeds_[below(seeds_.size())].content;
  text.resize(below(text.size() + 1));
  text += other.substr(below(other.size()));
}

std::string Mutator::from_nothing() {
  std::string text;
  for (std::uint64_t parts = below(40); parts > 0; --parts) {
    switch (below(3)) {
      case 0:
        text += words[below(words.size())];
        break;
      case 1:
        text += numbers[below(numbers.size())];
        break;
      default:
        text += static_cast<char>(below(256));
        break;
    }
  }
  return text;
}

std::string Mutator::packed(const std::string& text) {
  z_stream zlib{};
  constexpr int small_window = 16 + 10;  // the least memory, for speed
  if (deflateInit2(&zlib, static_cast<int>(below(10)), Z_DEFLATED, small_window, 1, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("deflateInit2");
  }
  std::string result(deflateBound(&zlib, text.size()) + 64, '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  zlib.avail_in = static_cast<uInt>(text.size());
  zlib.next_out = reinterpret_cast<Bytef*>(result.data());
  zlib.avail_out = static_cast<uInt>(result.size());
  const int status = deflate(&zlib, Z_FINISH);
  result.resize(zlib.total_out);
  deflateEnd(&zlib);
  if (status != Z_STREAM_END) throw std::runtime_error("deflate");
  return result;
}

}  // namespace odds::fuzz
