// libFuzzer: any bytes as STL, plain or packed.
#include <cstdint>

#include "check_reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  odds::fuzz::read_and_check(std::as_bytes(std::span(data, size)), odds::mesh::Format::stl);
  return 0;
}
