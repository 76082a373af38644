// Who is served in a frame that cannot serve all.
#include <algorithm>
#include <cmath>

#include "ode/frame/frame_budget.hpp"

namespace odds::ode {
namespace {

constexpr double most_for_holding = 0.5;  // of what is left
constexpr double contentment = 0.125;     // weight of a pair that has finished within its need

}  // namespace

void plan(std::vector<FrameCandidate>& candidates, const FrameMeans& means) noexcept {
  double touching = 0.0;
  for (const FrameCandidate& candidate : candidates) touching += candidate.memory->touches ? 1.0 : 0.0;
  const double hold = std::min(means.hold, most_for_holding * std::max(0.0, means.left) / std::max(1.0, touching));
  double room = means.left - hold * touching;
  bool first = true;  // is called in any case
  for (FrameCandidate& candidate : candidates) {
    candidate.need = candidate.memory->need.least_share(means.unknown, means.most);
    const double released = candidate.memory->touches ? hold : 0.0;
    candidate.planned = candidate.need <= room + released || first;
    if (candidate.planned) room += released - candidate.need;
    first = false;
  }
  double kept = 0.0;
  for (const FrameCandidate& candidate : candidates) {
    kept += !candidate.planned && candidate.memory->touches ? hold : 0.0;
  }
  double rivals = 0.0;
  for (auto candidate = candidates.rbegin(); candidate != candidates.rend(); ++candidate) {
    if (!candidate->planned) continue;
    candidate->weight = std::exp2(candidate->importance) * (candidate->memory->need.is_hungry() ? 1.0 : contentment);
    rivals += candidate->weight;
    candidate->rivals = rivals;
    candidate->kept = kept;
    kept += candidate->need;
  }
}

}  // namespace odds::ode
