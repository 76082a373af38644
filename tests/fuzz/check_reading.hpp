// What must hold for any bytes whatever that are given to the readers; shared by libFuzzer's targets and the driver.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "odds/mesh/read.hpp"

namespace odds::fuzz {

/// Looks at what reading `bytes` as `name` gave: a mesh must be valid, an error must name its file and a place inside
/// the input, and say what is wrong and what to do. Returns what does not hold, or an empty string.
std::string complaint(const Result<mesh::TriangleMesh>& result, std::span<const std::byte> bytes,
                      const std::string& name);

/// For libFuzzer: reads and aborts with the complaint, if there is one.
void read_and_check(std::span<const std::byte> bytes, std::optional<mesh::Format> format);

}  // namespace odds::fuzz
