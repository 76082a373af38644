// What the commands that answer one question for each pose of a file share: their arguments, and what they open.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/output_file.hpp"
#include "odds/math/pose.hpp"
#include "odds/query/budget.hpp"
#include "odds/query/pair.hpp"
#include "tool/pair_argument.hpp"

namespace odds::tool {

struct PoseRunArguments {
  PairArgument pair;
  std::string poses;
  std::string out;
  double budget_us = 0.0;  ///< 0: not given
  std::uint64_t work = 0;  ///< 0: not given

  /// `budget` with what was given.
  [[nodiscard]] query::Budget limited(query::Budget budget) const;
};

/// Adds A, B, --poses, --out, --budget-us, --work, --scale-a, --scale-b.
void add_pose_run_options(CLI::App& command, PoseRunArguments& arguments, const std::string& out_help);

/// Opened in an order that fails early: the poses, the output, then the meshes, whose hierarchies take time.
struct PoseRun {
  std::vector<math::Pose> poses;
  mesh::OutputFile out;
  query::Pair pair;

  [[nodiscard]] static Result<PoseRun> open(const PoseRunArguments& arguments);
};

}  // namespace odds::tool
