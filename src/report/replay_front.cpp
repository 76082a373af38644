#include "report/replay_front.hpp"

#include <set>
#include <utility>

#include "odds/volume/aabb.hpp"

namespace odds::report {
namespace {

using query::UpperBox;

volume::Aabb along_axes(const UpperBox& box) {
  volume::Aabb aabb;
  aabb.center_ = box.center.cast<float>();
  aabb.half_ = box.half.cast<float>();
  return aabb;
}

bool opens(const UpperBox& box, std::size_t opened) { return box.children > 0 && box.first + box.children <= opened; }

/// Adds the boxes of both that the search ends at.
void search(const std::vector<UpperBox>& a, const std::vector<UpperBox>& b, const math::Pose& b_in_a,
            std::size_t opened, std::set<std::size_t>& of_a, std::set<std::size_t>& of_b) {
  if (a.empty() || b.empty()) return;
  const double reach = a[0].center.norm() + a[0].half.norm() + b[0].center.norm() + b[0].half.norm();
  const auto pose = volume::Aabb::PreparedPose::make(b_in_a, 2.0 * reach);
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, 0}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (!volume::overlap(along_axes(a[i]), along_axes(b[j]), pose)) continue;
    const bool open_a = opens(a[i], opened);
    const bool open_b = opens(b[j], opened);
    if (!open_a && !open_b) {
      of_a.insert(i);
      of_b.insert(j);
    } else if (open_a && (!open_b || a[i].half.norm() >= b[j].half.norm())) {
      for (std::size_t k = 0; k < a[i].children; ++k) open.emplace_back(a[i].first + k, j);
    } else {
      for (std::size_t k = 0; k < b[j].children; ++k) open.emplace_back(i, b[j].first + k);
    }
  }
}

}  // namespace

std::vector<FrontBox> front_of(const RunReplay& replay, const ReplayFrame& frame, std::size_t opened,
                               std::size_t most) {
  std::vector<math::Pose> poses;
  std::size_t next = 0;
  for (const ReplayBody& body : replay.bodies) poses.push_back(body.moves ? frame.poses[next++] : body.pose);
  std::vector<std::set<std::size_t>> met(replay.bodies.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      if (!replay.bodies[i].moves && !replay.bodies[j].moves) continue;
      search(replay.meshes[replay.bodies[i].mesh].boxes, replay.meshes[replay.bodies[j].mesh].boxes,
             poses[i].inverse() * poses[j], opened, met[i], met[j]);
    }
  }
  std::vector<FrontBox> front;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (const std::size_t at : met[i]) {
      const UpperBox& box = replay.meshes[replay.bodies[i].mesh].boxes[at];
      if (front.size() < most) front.push_back({poses[i] * box.center, poses[i].rotation, box.half});
    }
  }
  return front;
}

}  // namespace odds::report
