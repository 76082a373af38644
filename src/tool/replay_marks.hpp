// Contacts and guesses of a run, for the eye.
#pragma once

#include <memory>
#include <vector>

#include "odds/query/pair.hpp"
#include "odds/report/run_replay.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::tool {

/// Asks the scene's question again at the poses of a frame, for every pair of bodies of which one moves: the same
/// method, the same budget, in work units. Its contacts, or the most probable pair of cells, become marks.
class ReplayMarks {
 public:
  explicit ReplayMarks(const scene::Simulation& simulation);

  /// `poses`: of all bodies, in the scene's order. After 50,000 queries, or beyond 64 marks of a frame, it stops.
  void add(const std::vector<math::Pose>& poses, report::ReplayFrame& frame);

 private:
  struct Ball {
    Vec3 center = Vec3::Zero();
    double radius = 0.0;
  };
  void ask(std::size_t a, std::size_t b, const std::vector<math::Pose>& poses, report::ReplayFrame& frame);

  const scene::Simulation& simulation_;
  query::Request request_;
  std::vector<Ball> balls_;                          // around each body, in its frame
  std::vector<std::unique_ptr<query::Pair>> pairs_;  // by a * bodies + b; made when first needed
  std::size_t queries_ = 0;
};

}  // namespace odds::tool
