// What must hold for any bytes whatever that are given as a saved shape; shared by libFuzzer's target and the driver.
#pragma once

#include <span>
#include <string>

namespace odds::fuzz {

/// Loads `bytes` and asks what was loaded everything that can be asked. Returns what does not hold, or an empty string;
/// `loaded` (if not null) says whether there was a shape to ask.
std::string complaint_about_shape(std::span<const std::byte> bytes, bool* loaded = nullptr);

}  // namespace odds::fuzz
