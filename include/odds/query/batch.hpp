// Many poses of two shapes, on all processors: for planners and studies, not for a real-time loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {

/// What Pair::run says of one pose; its contacts stand in memory of the caller's.
struct BatchAnswer {
  Verdict verdict = Verdict::clear;
  Basis basis = Basis::proved;
  double probability = 0.0;  ///< of a hit, in [0, 1]; exactly 1 or 0 where proved
  std::uint32_t contacts = 0;
  bool contacts_complete = true;  ///< see Answer
  Cost cost;
};

/// Pairs of the same two shapes, one for each thread, and the threads that they run on. Every pose is answered as by a
/// pair that is new, whatever came before it in its thread: without a limit, or with one in work units, the answers are
/// the same bits for any number of threads and any order of poses.
class Batch {
 public:
  /// `threads` 1 .. 1024, or 0: as many as the machine has processors. Refuses what Pair::make refuses. May throw
  /// bad_alloc.
  static Result<Batch> make(std::shared_ptr<const Shape> a, std::shared_ptr<const Shape> b,
                            const PairOptions& options = {}, std::size_t threads = 0);

  /// Answers for each pose of B's mesh frame in A's mesh frame: answers[i] for poses[i], and where they are wanted the
  /// contacts of pose i from contacts[i * request.max_contacts] on (A's mesh frame, best first). Method::incremental,
  /// which lives from the pose before, is as exact. A pose or request that Pair::run refuses has its answer. An error,
  /// and nothing written, where `answers` has not as many places as there are poses, or `contacts`, if it is not empty,
  /// not max_contacts times as many. Starts and joins threads; may throw bad_alloc. One call at a time.
  [[nodiscard]] std::optional<Error> run(std::span<const math::Pose> poses_b_in_a, const Request& request,
                                         std::span<BatchAnswer> answers, std::span<Contact> contacts = {});

  /// How many poses are answered at once.
  [[nodiscard]] std::size_t threads() const noexcept { return pairs_.size(); }

 private:
  explicit Batch(std::vector<Pair> pairs) noexcept : pairs_(std::move(pairs)) {}
  std::vector<Pair> pairs_;
};

}  // namespace odds::query
