// Carries a study of accuracy out: makes the poses, proves what is true in them, answers them under every limit.
#pragma once

#include <memory>

#include "odds/query/pair.hpp"
#include "odds/report/accuracy/study.hpp"

namespace odds::tool {

/// The two bodies, ready for queries.
struct StudyShapes {
  std::shared_ptr<const query::Shape> a, b;            ///< as asked for
  std::shared_ptr<const query::Shape> wide_a, wide_b;  ///< of the wide engine, for poses and truth
};

/// Fills poses and samples of a study whose settings and shard are set. Shows progress on a terminal.
[[nodiscard]] std::optional<Error> carry_out(const StudyShapes& shapes, query::EstimatorKind estimator,
                                             report::Study& study);

}  // namespace odds::tool
