// A run as a GLB file, for Blender and every other program that reads glTF.
#pragma once

#include <span>
#include <string>

#include "odds/haptics/tick_record.hpp"
#include "odds/math/error.hpp"
#include "odds/report/run_info.hpp"
#include "odds/report/run_replay.hpp"

namespace odds::report {

/// The bytes of a GLB file (glTF 2.0, binary): a node for each body, with the run as an animation in seconds; an arrow
/// for the force on the hand, as long as the largest body for the greatest force; marks for contacts and for the most
/// probable pairs of cells, hidden (of no size) where there are none. Metres; glTF's y is up, so a node named "world"
/// turns the scene's z to it. Positions are told from the first body's place, which stands in the "extras" of that node
/// as origin_m: floats are too coarse far from the origin. An error where the file
/// would be larger than the 4 GiB that the format can state.
[[nodiscard]] Result<std::string> replay_glb(const RunInfo& info, const RunReplay& replay,
                                             std::span<const haptics::TickRecord> ticks);

}  // namespace odds::report
