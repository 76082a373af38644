#include "tool/pose_run.hpp"

#include <limits>

#include "tool/poses_csv.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {

query::Budget PoseRunArguments::limited(query::Budget budget) const {
  if (budget_us > 0.0) budget.microseconds = budget_us;
  if (work > 0) budget.work_units = work;
  return budget;
}

void add_pose_run_options(CLI::App& command, PoseRunArguments& arguments, const std::string& out_help) {
  command.add_option("A", arguments.pair.mesh_a, shape_argument_help())->required();
  command.add_option("B", arguments.pair.mesh_b, "as A")->required();
  command
      .add_option("--poses", arguments.poses, "CSV with columns x,y,z (metres), qw,qx,qy,qz: pose of B in A's frame")
      ->required();
  command.add_option("--out", arguments.out, out_help)->required();
  CLI::Option* budget = command.add_option("--budget-us", arguments.budget_us, "microseconds for one query, > 0");
  budget->check(positive_and_finite());
  command.add_option("--work", arguments.work, "work units for one query, > 0: repeatable bit for bit")
      ->check(whole_number(1, std::numeric_limits<std::uint64_t>::max()))
      ->excludes(budget);
  command.add_option("--scale-a", arguments.pair.scale_a, "metres per unit of A's file")->check(positive_and_finite());
  command.add_option("--scale-b", arguments.pair.scale_b, "metres per unit of B's file")->check(positive_and_finite());
}

Result<PoseRun> PoseRun::open(const PoseRunArguments& arguments) {
  Result<std::vector<math::Pose>> poses = read_poses(arguments.poses);
  if (!poses.ok()) return poses.error();
  const auto in_the_way =
      mesh::refuse_overwriting(arguments.out, {arguments.poses, arguments.pair.mesh_a, arguments.pair.mesh_b});
  if (in_the_way) return *in_the_way;
  Result<mesh::OutputFile> out = mesh::OutputFile::open_or_standard_output(arguments.out);
  if (!out.ok()) return out.error();
  Result<query::Pair> pair = make_pair(arguments.pair);
  if (!pair.ok()) return pair.error();
  return PoseRun{std::move(poses).value(), std::move(out).value(), std::move(pair).value()};
}

}  // namespace odds::tool
