// odds_near_poses A B COUNT SEED OUT.csv: poses around first touch, found by FCL, with FCL's verdict for each.
// The file is a POSES.csv for `odds query`; its further columns are `band` (offset from first touch in units of A's size,
// positive: apart), `fcl` (1: FCL says they meet) and `fcl_us` (median of 3).
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "differential/fcl_oracle.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"
#include "support/near_poses.hpp"

namespace {

using namespace odds;

// The classes of the published comparison: near 0.2-5 % apart, touch, shallow 0.2-2 % inside, deep 10-50 %.
constexpr std::array bands = {5e-2, 1e-2, 2e-3, 1e-3, 1e-4, 1e-6, -1e-6, -1e-4, -1e-3, -2e-3, -1e-2, -2e-2, -0.1, -0.3};

mesh::TriangleMesh load(const std::string& argument) {
  auto mesh = argument.starts_with(mesh::made::prefix) ? mesh::made::make_shape(argument) : mesh::read(argument);
  if (!mesh.ok()) {
    std::fprintf(stderr, "error: %s\n", mesh.error().message().c_str());
    std::exit(1);
  }
  return std::move(mesh).value();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: odds_near_poses A B COUNT SEED OUT.csv\n");
    return 2;
  }
  const mesh::TriangleMesh a = load(argv[1]);
  const mesh::TriangleMesh b = load(argv[2]);
  const auto count = std::strtoull(argv[3], nullptr, 10);
  math::Random random(std::strtoull(argv[4], nullptr, 10));
  const testing::FclModel fcl_a(a);
  const testing::FclModel fcl_b(b);
  std::ofstream out(argv[5]);
  out.precision(17);
  out << "# first touch by FCL; A " << a.name() << ", B " << b.name() << ", seed " << argv[4] << "\n";
  out << "x,y,z,qw,qx,qy,qz,band,fcl,fcl_us\n";
  const Vec3 center_a = 0.5 * (a.lower() + a.upper());
  const Vec3 center_b = 0.5 * (b.lower() + b.upper());
  testing::TouchingPose touching;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i % bands.size() == 0) {
      touching = testing::touching_pose(random, center_a, center_b, std::max(a.size(), b.size()),
                                        [&](const math::Pose& pose) { return testing::fcl_collide(fcl_a, fcl_b, pose); });
    }
    math::Pose pose = touching.pose;
    const double band = bands[i % bands.size()];
    pose.translation += band * a.size() * touching.direction;
    bool hit = false;
    std::array<double, 3> microseconds{};
    for (double& time : microseconds) {
      const auto start = std::chrono::steady_clock::now();
      hit = testing::fcl_collide(fcl_a, fcl_b, pose);
      time = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    }
    std::sort(microseconds.begin(), microseconds.end());
    const Quat q(pose.rotation);
    out << pose.translation.x() << ',' << pose.translation.y() << ',' << pose.translation.z() << ',' << q.w() << ',' << q.x()
        << ',' << q.y() << ',' << q.z() << ',' << band << ',' << (hit ? 1 : 0) << ',' << microseconds[1] << '\n';
  }
  return out.good() ? 0 : 1;
}
