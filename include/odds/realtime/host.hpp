// What machine this is and how ready it is for real-time work: the block that every timing report carries.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace odds::realtime {

/// One property of the host.
struct HostLine {
  enum class Readiness : std::uint8_t {
    neutral,  ///< information only
    good,     ///< helps steady timing
    hinders,  ///< lengthens the tail of latencies; `remark` says how and what would help
    unknown,  ///< could not be read
  };
  std::string name;   ///< "governor"
  std::string value;  ///< "performance"
  Readiness readiness = Readiness::neutral;
  std::string remark;  ///< may be empty
};

[[nodiscard]] const char* name(HostLine::Readiness readiness) noexcept;

/// Reads the properties from the kernel's files. `root` is put before each path ("" for the real machine), so that
/// tests can describe machines that they do not run on. Slow (files, and the clock's calibration at the first call);
/// thread-safe. Never fails: what cannot be read is said to be unknown.
[[nodiscard]] std::vector<HostLine> describe_host(const std::string& root = "");

}  // namespace odds::realtime
