// Output that is full, closed, too large or on a broken disk is an error like any other, never lost text.
#pragma once

#include <optional>

#include "odds/math/error.hpp"

namespace odds::tool {

/// Puts /dev/null in the place of standard streams that the caller closed, so that no file opened later takes their
/// number and receives messages. What is then written to standard output fails, as it would on the closed stream.
void occupy_closed_streams() noexcept;

/// Makes writing beyond the size that files may have (`ulimit -f`) an error, where the system would end the program
/// without a word, its temporary file left behind.
void survive_size_limits() noexcept;

/// Writes out what standard output still holds; the error says why it could not be written.
std::optional<Error> flush_standard_output();

}  // namespace odds::tool
