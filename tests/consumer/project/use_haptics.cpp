// Uses the haptics library: its list of devices.
#include <odds/haptics/device_registry.hpp>

#include <cstdio>

int main() {
  const auto names = odds::haptics::device_names();
  std::printf("haptics: %zu kinds of device\n", names.size());
  return names.empty() ? 1 : 0;
}
