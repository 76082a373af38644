// The folder from which a run can be repeated or shown: the device's track, the poses, and what they belong to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "odds/math/error.hpp"
#include "odds/report/run_info.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::tool {

/// Writes device.csv (a track for the device type "replay"), poses.csv (moving bodies, for pictures) and replay.json
/// (the side-car: scene, meshes, fixed poses, budget, units) and replay.glb (`glb`, for programs that draw). Makes the
/// folder; replaces files of an earlier run, each whole or not at all. An error in place of `glb` is returned when the
/// rest is written.
[[nodiscard]] std::optional<Error> write_replay_folder(const std::filesystem::path& folder,
                                                       const scene::Simulation& simulation, const report::RunInfo& info,
                                                       const scene::RunOutcome& outcome,
                                                       const Result<std::string>& glb);

}  // namespace odds::tool
