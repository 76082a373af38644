// Boxes over a mesh for the eye: halves at the median of the longest axis.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "odds/report/run_replay.hpp"

namespace odds::report {
namespace {

using Corner = std::array<float, 3>;

class Boxes {
 public:
  Boxes(const ReplayMesh& mesh, int levels) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    boxes_.resize((std::size_t{1} << levels) - 1);
    fill(0, order_);
  }
  std::vector<ReplayBox> take() { return std::move(boxes_); }

 private:
  // A single triangle is handed down whole, so that every box of the tree is there.
  void fill(std::size_t at, std::span<std::uint32_t> triangles) {
    if (at >= boxes_.size()) return;
    Corner lower;
    Corner upper;
    lower.fill(std::numeric_limits<float>::max());
    upper.fill(std::numeric_limits<float>::lowest());
    for (const std::uint32_t t : triangles) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        for (std::size_t k = 0; k < 3; ++k) {
          lower[k] = std::min(lower[k], mesh_.vertices[v][k]);
          upper[k] = std::max(upper[k], mesh_.vertices[v][k]);
        }
      }
    }
    std::size_t longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      boxes_[at].center[k] = 0.5F * (lower[k] + upper[k]);
      boxes_[at].half[k] = 0.5F * (upper[k] - lower[k]);
      if (boxes_[at].half[k] > boxes_[at].half[longest]) longest = k;
    }
    if (triangles.size() == 1) {
      fill(2 * at + 1, triangles);
      fill(2 * at + 2, triangles);
      return;
    }
    const auto middle = static_cast<std::ptrdiff_t>(triangles.size() / 2);
    std::nth_element(triangles.begin(), triangles.begin() + middle, triangles.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return along(a, longest) < along(b, longest); });
    fill(2 * at + 1, triangles.first(static_cast<std::size_t>(middle)));
    fill(2 * at + 2, triangles.subspan(static_cast<std::size_t>(middle)));
  }
  [[nodiscard]] float along(std::uint32_t t, std::size_t axis) const {
    float sum = 0.0F;
    for (const std::uint32_t v : mesh_.triangles[t]) sum += mesh_.vertices[v][axis];
    return sum;
  }

  const ReplayMesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<ReplayBox> boxes_;
};

}  // namespace

std::vector<ReplayBox> upper_boxes(const ReplayMesh& mesh, int levels) {
  if (mesh.triangles.empty()) return {};
  return Boxes(mesh, std::clamp(levels, 1, 12)).take();
}

}  // namespace odds::report
