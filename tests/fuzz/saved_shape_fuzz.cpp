// libFuzzer: any bytes as a saved shape, their checksums made right so that what lies behind them is reached.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "check_saved_shape.hpp"
#include "support/saved_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size >= sizeof(odds::tree::SavedHeader)) odds::testing::reseal(bytes);
  const std::string found = odds::fuzz::complaint_about_shape(odds::testing::bytes_of(bytes));
  if (found.empty()) return 0;
  std::fprintf(stderr, "%s\n", found.c_str());
  std::abort();
}
