// Noting and writing poses.
#include "odds/scene/pose_track.hpp"

#include <fmt/core.h>

#include "mesh/csv_field.hpp"
#include "mesh/output_file.hpp"

namespace odds::scene {

PoseTrack::PoseTrack(std::vector<ode::BodyId> bodies, std::vector<std::string> names, std::uint64_t stride,
                     std::uint64_t ticks)
    : bodies_(std::move(bodies)),
      names_(std::move(names)),
      stride_(stride),
      rows_(bodies_.size() * static_cast<std::size_t>(ticks / stride + 1)) {}

void PoseTrack::note(std::uint64_t tick, std::int64_t t_ns, const ode::World& world) noexcept {
  if (tick < next_ || used_ + bodies_.size() > rows_.size()) return;
  next_ = (tick / stride_ + 1) * stride_;  // a skipped tick's turn is taken by the next one that runs
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const math::Pose pose = world.state(bodies_[i]).pose;
    rows_[used_++] = {tick, t_ns, static_cast<std::uint32_t>(i), pose.translation, Quat(pose.rotation)};
  }
}

std::optional<Error> PoseTrack::write(const std::filesystem::path& path) const {
  Result<mesh::OutputFile> opened = mesh::OutputFile::open(path);
  if (!opened) return opened.error();
  mesh::OutputFile& file = opened.value();
  std::vector<std::string> fields;
  for (const std::string& name : names_) fields.push_back(mesh::csv_field(name));
  file.write("tick,t_ns,body,px_m,py_m,pz_m,qw,qx,qy,qz\n");
  for (std::size_t i = 0; i < used_; ++i) {
    const Row& row = rows_[i];
    const Vec3& p = row.position_m;
    const Quat& q = row.orientation;
    file.write(fmt::format("{},{},{},{},{},{},{},{},{},{}\n", row.tick, row.t_ns, fields[row.body], p.x(), p.y(), p.z(),
                           q.w(), q.x(), q.y(), q.z()));
  }
  return file.commit();
}

}  // namespace odds::scene
