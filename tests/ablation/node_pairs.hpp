// Probabilities of pairs of nodes under every estimator and volume of overlap, and what is true below them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "calibration/named_shape.hpp"
#include "odds/math/pose.hpp"

namespace odds::ablation {

/// What an estimate is made with.
struct EstimateKind {
  std::string_view name;
  bool kinematic;
  bool enclosing_box;   ///< the overlap is taken with the box in A's axes about B, instead of with B's volume itself
  bool learnt = false;  ///< the odds that the search uses, with weights fitted on other meshes
};
inline constexpr std::array<EstimateKind, 5> estimate_kinds = {{{"kinematic, as the search uses it", true, false, true},
                                                                {"kinematic, overlap of the volumes", true, false},
                                                                {"kinematic, overlap of enclosing boxes", true, true},
                                                                {"cells, overlap of the volumes", false, false},
                                                                {"cells, overlap of enclosing boxes", false, true}}};

/// One pair of nodes whose volumes overlap.
struct JudgedNodes {
  std::array<double, estimate_kinds.size()> probability{};
  bool meet = false;       ///< triangles below both meet
  std::uint64_t line = 0;  ///< caller's number of the pose's group
};

/// Some of the pairs that an exhaustive search looks at in this pose, each as likely as any other, and never the roots.
/// Precondition: shapes of one volume of the generic framework.
void judge_nodes(const query::Shape& a, const query::Shape& b, const math::Pose& b_in_a, std::uint64_t line,
                 std::vector<JudgedNodes>& judged);

/// Probability that a pair that meets was given more than one that does not; 0.5 for equals. (Area under the receiver's
/// operating curve.) 0.5 if all are alike.
[[nodiscard]] double separation(const std::vector<JudgedNodes>& judged, std::size_t kind);

}  // namespace odds::ablation
