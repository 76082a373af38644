// A run as the report page shows it again.
#pragma once

#include "odds/report/run_replay.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::tool {

/// Meshes simplified for the eye, and at most some thousand frames.
[[nodiscard]] report::RunReplay replay_view(const scene::Simulation& simulation, const scene::RunOutcome& outcome);

}  // namespace odds::tool
