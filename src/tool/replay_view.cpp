// From the track of poses to frames.
#include "tool/replay_view.hpp"

#include <algorithm>

#include "tool/replay_marks.hpp"

namespace odds::tool {
namespace {

constexpr std::size_t most_triangles = 20'000;  // of one mesh: a page that opens at once
constexpr std::size_t most_frames = 6'000;
constexpr std::size_t most_boxes = 1000;  // of one mesh

}  // namespace

report::RunReplay replay_view(const scene::Simulation& simulation, const scene::RunOutcome& outcome) {
  report::RunReplay replay;
  for (const auto& shape : simulation.shapes()) {
    report::ReplayMesh mesh = report::simplified(shape->mesh(), most_triangles);
    mesh.boxes = query::upper_boxes(*shape, most_boxes);
    replay.meshes.push_back(std::move(mesh));
  }
  for (const scene::Body& body : simulation.scene().bodies) {
    replay.bodies.push_back({body.name, body.mesh, body.dynamic, body.follows_device, body.pose});
  }
  const std::vector<scene::PoseTrack::Row> rows = outcome.poses.rows();
  const std::size_t moving = outcome.poses.names().size();
  if (moving == 0) return replay;
  const std::size_t frames = rows.size() / moving;
  ReplayMarks marks(simulation);
  std::vector<math::Pose> everywhere;
  for (const scene::Body& body : simulation.scene().bodies) everywhere.push_back(body.pose);
  const std::size_t stride = std::max<std::size_t>(1, (frames + most_frames - 1) / most_frames);
  for (std::size_t i = 0; i < frames; i += stride) {
    report::ReplayFrame frame;
    frame.tick = rows[i * moving].tick;
    for (std::size_t k = 0; k < moving; ++k) {
      const scene::PoseTrack::Row& row = rows[i * moving + k];
      frame.poses.push_back(math::Pose::from_quaternion(row.position_m, row.orientation));
    }
    std::size_t next = 0;
    for (std::size_t k = 0; k < everywhere.size(); ++k) {
      if (simulation.scene().bodies[k].dynamic) everywhere[k] = frame.poses[next++];
    }
    marks.add(everywhere, frame);
    replay.frames.push_back(std::move(frame));
  }
  return replay;
}

}  // namespace odds::tool
