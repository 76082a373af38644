// Reading poses from a CSV file.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"

namespace odds::tool {

/// Poses of B in A's frame, in the order of the file. The first line that is neither empty nor a comment ('#') is the
/// header; its columns x, y, z (metres) and qw, qx, qy, qz (a quaternion, normalised here) may stand in any order among
/// others, which are ignored. Numbers are plain decimals, independent of the locale. Fields may be quoted; LF and CRLF
/// both end a line. Refused with the line: missing or repeated columns, short or long rows, lines of more than a
/// mebibyte, text that is not a finite number, positions beyond 1e15 m, a zero quaternion; and a file without poses.
Result<std::vector<math::Pose>> read_poses(const std::string& path);

/// The same from a stream; `name` stands in error messages.
Result<std::vector<math::Pose>> read_poses(std::istream& stream, const std::string& name);

}  // namespace odds::tool
