// libFuzzer: any bytes, the format chosen by content.
#include <cstdint>

#include "check_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  odds::fuzz::read_and_check(std::as_bytes(std::span(data, size)), std::nullopt);
  return 0;
}
