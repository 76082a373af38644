// Searches that ended without a proof: what they left undecided, and what was true.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/query/request.hpp"
#include "odds/report/accuracy/poses.hpp"
#include "odds/volume/kind.hpp"
#include "query/answer_odds/remains.hpp"

namespace odds::calibration {

/// Two meshes (files or made: names) and how they come together.
struct Meeting {
  std::string a, b;
  report::Procedure procedure = report::Procedure::distance;
};

struct Unproved {
  query::Remains remains;
  bool judged = false;  ///< without polygons: no budget ended it, see query::SearchResult::is_judged
  bool hit = false;
  double offset = 0.0;  ///< from first touch, parts of the size; see report::PoseBand
};

/// A way to answer.
struct Way {
  query::EstimatorKind estimator = query::EstimatorKind::kinematic;
  query::Method method = query::Method::time_critical;
  bool polygon_free = false;
};

/// How the poses of a meeting are answered.
struct Asked {
  volume::Kind volume = volume::Kind::wide;
  std::vector<Way> ways;
  std::vector<std::uint64_t> units;  ///< limits, each tried on every pose
  std::uint64_t poses_per_band = 0;
  std::uint64_t seed = 0;
};

/// Answers all poses within all limits, incremental searches each from the beginning; returns what was not proved,
/// for each way. Fails as reading, building and posing do.
[[nodiscard]] Result<std::vector<std::vector<Unproved>>> unproved_answers(const Meeting& meeting, const Asked& asked);

}  // namespace odds::calibration
