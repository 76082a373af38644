// Where the moving bodies of a scene were, at a rate fit for looking at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/ode/world.hpp"

namespace odds::scene {

/// Poses of all moving bodies at every `stride`-th tick. Memory is taken, and touched, at construction.
class PoseTrack {
 public:
  struct Row {
    std::uint64_t tick = 0;
    std::int64_t t_ns = 0;
    std::uint32_t body = 0;  ///< index into names()
    Vec3 position_m = Vec3::Zero();
    Quat orientation = Quat::Identity();
  };

  PoseTrack() = default;
  PoseTrack(std::vector<ode::BodyId> bodies, std::vector<std::string> names, std::uint64_t stride, std::uint64_t ticks);

  /// Notes the poses if the tick's turn has come. noexcept, no allocation; when memory is full nothing is noted any
  /// more.
  void note(std::uint64_t tick, std::int64_t t_ns, const ode::World& world) noexcept;

  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] std::vector<Row> rows() const {
    return {rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(used_)};
  }

  /// CSV: tick,t_ns,body,px_m,py_m,pz_m,qw,qx,qy,qz.
  [[nodiscard]] std::optional<Error> write(const std::filesystem::path& path) const;

 private:
  std::vector<ode::BodyId> bodies_;
  std::vector<std::string> names_;
  std::uint64_t stride_ = 1;
  std::uint64_t next_ = 0;
  std::vector<Row> rows_;
  std::size_t used_ = 0;
};

}  // namespace odds::scene
