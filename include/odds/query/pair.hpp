// Two shapes and all the memory that queries between them need.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/contact_patch.hpp"
#include "odds/query/distance.hpp"
#include "odds/query/request.hpp"
#include "odds/query/shape.hpp"

namespace odds::query {

/// What the wide engine's searches and contact patches run on; rays run on the best. All give the same bits.
enum class InstructionSet : std::uint8_t {
  best,    ///< the widest that the program was built with and the processor has
  avx512,  ///< x86 with AVX-512 VBMI2: Intel since 2019 (servers 2021), AMD since 2022; not the older ones, whose clock
           ///< it slows
  avx2,    ///< x86, since 2013
  sse2,    ///< every x86-64
  neon,    ///< every 64-bit ARM
  portable,  ///< plain C++
};

struct PairOptions {
  std::uint32_t queue_capacity = 4096;   ///< pairs of nodes in the priority queue, 64 .. 2^20
  std::uint32_t slice_capacity = 16384;  ///< nodes of the test tree kept by the incremental method, 64 .. 2^24
  std::uint32_t hit_capacity = 512;      ///< intersecting triangle pairs kept for contacts, 8 .. 65536
  InstructionSet instruction_set = InstructionSet::best;
  /// Poses on which `make` learns how true the general odds are for this very pair; 0: none. About 0.2 ms each; 240 and
  /// more are worth it. The pair keeps what it learnt. Of shapes with polygons.
  std::uint32_t calibration_poses = 0;
  /// Memory for Request::late_contacts: 3.7 MB, shared by all pairs with the same capacities, once for each pair but no
  /// more than 64 times; of more that would use it at once, some make their contacts as without.
  bool late_contacts = false;
};

/// A workspace for queries between two shapes. All memory is taken in `make`; `run` never allocates, locks, throws or
/// makes a system call (the clock is read from user space). One pair per thread; shapes may be shared. With the default
/// options a pair keeps 0.5 MB, less of small meshes; a megabyte more is shared by all pairs with the same capacities,
/// once for each pair but no more than 32 times (or as many as the processor runs threads: of more than that at once,
/// one waits for another).
class Pair {
 public:
  struct Implementation;  // private to src/query

  /// Refuses two shapes of unlike bounding volumes, options out of range, and instructions that are not there.
  static Result<Pair> make(std::shared_ptr<const Shape> a, std::shared_ptr<const Shape> b,
                           const PairOptions& options = {});
  ~Pair();
  Pair(Pair&&) noexcept;
  Pair& operator=(Pair&&) noexcept;

  /// Answers for one pose of B's mesh frame in A's mesh frame. A pose that is not rigid or not finite is answered at
  /// once: verdict clear, basis budget, probability 0.5, no contacts (it is the caller's error, and never a NaN).
  /// If one of the shapes has no polygons, every request is polygon-free.
  [[nodiscard]] const Answer& run(const math::Pose& pose_b_in_a, const Request& request) noexcept;

  /// How far both shapes are apart in one pose, and where they are nearest; 0 where they meet. Branch and bound on the
  /// wide engine: with another bounding volume, without polygons, or with a pose or request that is not usable, the
  /// answer is that nothing is known (lower 0, upper infinite, not proved). Beyond 1000 times the radii of both bodies
  /// together (of balls about the middles of their boxes) only the bounds are given. Touches no coherence of `run`.
  [[nodiscard]] DistanceAnswer distance(const math::Pose& pose_b_in_a,
                                        const DistanceRequest& request = {}) const noexcept;

  [[nodiscard]] const Shape& a() const noexcept;
  [[nodiscard]] const Shape& b() const noexcept;
  /// Pairs of triangles that the last `run` found to meet, `hit_capacity` at most (if carried, one); until the next
  /// run.
  [[nodiscard]] std::span<const TrianglePair> crossings() const noexcept;
  /// Pairs of nodes in the bottom slice that the incremental method keeps; 1 (the roots) before its first run.
  [[nodiscard]] std::uint32_t slice_size() const noexcept;
  /// Tells that the bodies were apart at this pose, as a broad phase knows that did not ask: contacts that there is no
  /// time to measure are then bounded by how far the bodies have come since, and push them back to where they were;
  /// what touched before is forgotten. The bodies must have gone from there to the next run's pose on a nearly straight
  /// way, and no run may have been in between. A pose that is not rigid says nothing.
  void note_apart(const math::Pose& pose_b_in_a) noexcept;
  /// Forgets coherence (last hit, bottom slice, last normal, contacts and direction), as if the pair were new.
  void reset() noexcept;

 private:
  explicit Pair(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace odds::query
