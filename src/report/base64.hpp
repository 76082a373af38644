// Base64 (RFC 4648) of byte strings.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace odds::report {

[[nodiscard]] std::string base64_encode(std::string_view bytes);
/// Nothing if `text` is not whole, padded base64.
[[nodiscard]] std::optional<std::string> base64_decode(std::string_view text);

}  // namespace odds::report
