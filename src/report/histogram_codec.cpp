// The V2 compressed encoding of a histogram: ZigZag LEB128 counters behind a header, deflated, in base64.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "odds/report/hlog.hpp"
#include "report/base64.hpp"

namespace odds::report {
namespace {

// HdrHistogram's V2 cookies; 0x10 says that counters are LEB128 of at most 9 bytes.
constexpr std::uint32_t cookie_payload = 0x1c849303U | 0x10U;
constexpr std::uint32_t cookie_compressed = 0x1c849304U | 0x10U;
constexpr std::size_t header_bytes = 40;
constexpr std::int64_t largest_total = std::int64_t{1} << 60;
constexpr std::size_t most_payload_bytes = std::size_t{64} << 20;

template <class Unsigned>
void put_big_endian(std::string& bytes, Unsigned value) {
  for (int shift = static_cast<int>(sizeof(Unsigned)) * 8 - 8; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<char>((value >> shift) & 0xFFU));
  }
}

template <class Unsigned>
Unsigned get_big_endian(std::string_view bytes, std::size_t at) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    value = static_cast<Unsigned>((value << 8) | static_cast<unsigned char>(bytes[at + i]));
  }
  return value;
}

void put_zigzag(std::string& bytes, std::int64_t value) {
  std::uint64_t rest = (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
  for (int i = 0; i < 8 && rest >= 0x80; ++i, rest >>= 7) bytes.push_back(static_cast<char>((rest & 0x7FU) | 0x80U));
  bytes.push_back(static_cast<char>(rest));  // the ninth byte carries eight bits
}

/// False at the end of the bytes or where they stop within a number.
bool get_zigzag(std::string_view bytes, std::size_t& at, std::int64_t& value) {
  std::uint64_t raw = 0;
  for (int i = 0; i < 9; ++i) {
    if (at >= bytes.size()) return false;
    const std::uint64_t byte = static_cast<unsigned char>(bytes[at++]);
    raw |= (i == 8 ? byte : byte & 0x7FU) << (7 * i);
    if (i == 8 || byte < 0x80U) break;
  }
  value = static_cast<std::int64_t>(raw >> 1) ^ -static_cast<std::int64_t>(raw & 1U);
  return true;
}

std::string counters_as_bytes(const Histogram& histogram) {
  std::string bytes;
  const auto counters = histogram.counters();
  const std::size_t end =
      histogram.count() == 0 ? 0 : histogram.counter_of(std::min(histogram.max(), histogram.range().highest)) + 1;
  for (std::size_t i = 0; i < end;) {
    if (counters[i] > 0) {
      put_zigzag(bytes, static_cast<std::int64_t>(counters[i]));
      ++i;
      continue;
    }
    std::int64_t zeros = 0;
    for (; i < end && counters[i] == 0; ++i) ++zeros;
    put_zigzag(bytes, -zeros);  // a negative number stands for that many empty counters
  }
  return bytes;
}

Error bad(const std::string& what) { return {"", "", what, "the V2 compressed encoding of HdrHistogram is expected"}; }

Result<std::string> inflate_payload(std::string_view compressed) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return bad("zlib could not start");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));  // zlib only reads it
  stream.avail_in = static_cast<uInt>(compressed.size());
  std::string bytes;
  std::array<char, 1 << 14> block{};
  int code = Z_OK;
  while (code == Z_OK && bytes.size() <= most_payload_bytes) {
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    code = inflate(&stream, Z_NO_FLUSH);
    bytes.append(block.data(), block.size() - stream.avail_out);
    if (stream.avail_in == 0 && stream.avail_out != 0 && code == Z_OK) code = Z_BUF_ERROR;  // cut off
  }
  inflateEnd(&stream);
  if (bytes.size() > most_payload_bytes) return bad("the payload is larger than 64 MiB");
  if (code != Z_STREAM_END) return bad("the compressed bytes are damaged or cut off");
  return bytes;
}

Result<Histogram> histogram_of(std::string_view payload) {
  if (payload.size() < header_bytes) return bad("the header is cut off");
  if (get_big_endian<std::uint32_t>(payload, 0) != cookie_payload) return bad("the payload's cookie is unknown");
  const auto length = get_big_endian<std::uint32_t>(payload, 4);
  if (length > payload.size() - header_bytes) return bad("the counters are cut off");
  // Bytes 8 to 11, the "normalising index offset", are skipped: counters come in order of value whatever it says, and
  // writers disagree about it (hdr-histogram-js puts 1).
  HistogramRange range;
  range.digits = static_cast<int>(get_big_endian<std::uint32_t>(payload, 12));
  range.lowest = static_cast<std::int64_t>(get_big_endian<std::uint64_t>(payload, 16));
  range.highest = static_cast<std::int64_t>(get_big_endian<std::uint64_t>(payload, 24));
  Result<Histogram> made = Histogram::make(range);
  if (!made) return bad(made.error().what);
  Histogram histogram = std::move(made).value();

  const std::string_view counters = payload.substr(header_bytes, length);
  std::size_t counter = 0;
  for (std::size_t at = 0; at < counters.size();) {
    std::int64_t number = 0;
    if (!get_zigzag(counters, at, number)) return bad("a counter is cut off");
    const std::size_t room = histogram.counters().size() - counter;
    const std::uint64_t steps = number > 0 ? 1 : std::uint64_t{0} - static_cast<std::uint64_t>(number);
    if (steps > room) return bad("more counters than its range has");
    if (number > largest_total - static_cast<std::int64_t>(histogram.count())) return bad("the counts are too large");
    if (number > 0) histogram.add_to_counter(counter, static_cast<std::uint64_t>(number));
    counter += number == 0 ? 1 : steps;
  }
  return histogram;
}

}  // namespace

std::string encode_histogram(const Histogram& histogram) {
  const std::string counters = counters_as_bytes(histogram);
  std::string payload;
  put_big_endian(payload, cookie_payload);
  put_big_endian(payload, static_cast<std::uint32_t>(counters.size()));
  put_big_endian(payload, std::uint32_t{0});  // normalising index offset
  put_big_endian(payload, static_cast<std::uint32_t>(histogram.range().digits));
  put_big_endian(payload, static_cast<std::uint64_t>(histogram.range().lowest));
  put_big_endian(payload, static_cast<std::uint64_t>(histogram.range().highest));
  put_big_endian(payload, std::bit_cast<std::uint64_t>(1.0));  // integer to double conversion ratio
  payload += counters;

  uLongf size = compressBound(static_cast<uLong>(payload.size()));
  std::string compressed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(compressed.data()), &size, reinterpret_cast<const Bytef*>(payload.data()),
            static_cast<uLong>(payload.size()), Z_BEST_COMPRESSION);
  compressed.resize(size);
  std::string bytes;
  put_big_endian(bytes, cookie_compressed);
  put_big_endian(bytes, static_cast<std::uint32_t>(compressed.size()));
  return base64_encode(bytes + compressed);
}

Result<Histogram> decode_histogram(std::string_view base64) {
  const auto bytes = base64_decode(base64);
  if (!bytes) return bad("not base64");
  if (bytes->size() < 8) return bad("the encoding is cut off");
  if (get_big_endian<std::uint32_t>(*bytes, 0) != cookie_compressed) return bad("the cookie is unknown");
  const auto length = get_big_endian<std::uint32_t>(*bytes, 4);
  if (length > bytes->size() - 8) return bad("the compressed bytes are cut off");
  Result<std::string> payload = inflate_payload(std::string_view(*bytes).substr(8, length));
  if (!payload) return payload.error();
  return histogram_of(payload.value());
}

}  // namespace odds::report
