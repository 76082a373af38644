// Where a search of one picture of the replay arrives in the hierarchies.
#pragma once

#include <cstddef>
#include <vector>

#include "odds/report/run_replay.hpp"

namespace odds::report {

/// In the world, metres.
struct FrontBox {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  Vec3 half = Vec3::Zero();
};

/// The boxes that overlap one of another body, where one of both moves, and are not opened further: each once, at most
/// `most`. Of each hierarchy the `opened` largest boxes are looked at.
[[nodiscard]] std::vector<FrontBox> front_of(const RunReplay& replay, const ReplayFrame& frame, std::size_t opened,
                                             std::size_t most);

}  // namespace odds::report
