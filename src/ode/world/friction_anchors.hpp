// What bodies that touch have slid since they came to rest, and how the solver is asked to take it back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "odds/math/types.hpp"
#include "odds/ode/odds_friction.h"

/// A table of a fixed size, by the unordered pair of geoms. Metres, radians.
///
/// A pair is anchored at a point of each body, which coincided where and when they came to rest: how far those have
/// come apart does not depend on the way there, as a sum of speeds does that bodies have where they happen to touch
/// while they rock. As a body rolls on, the points are chosen anew where it touches then.
struct oddsFrictionAnchors {
 public:
  oddsFrictionAnchors(std::size_t most_pairs, double most_slip_m);

  void next_step() noexcept { ++step_; }

  /// False: there is no room for the pair. Precondition: there is a contact, all that is given is finite and of one
  /// pair of geoms, one of the bodies is not null, and they differ.
  [[nodiscard]] bool hold(dBodyID b1, dBodyID b2, dContact* contacts, int count, double step_s) noexcept;

 private:
  /// Two geoms and their bodies, that of the lower address first.
  struct Touching {
    dGeomID geoms[2] = {nullptr, nullptr};
    dBodyID bodies[2] = {nullptr, nullptr};

    [[nodiscard]] bool operator==(const Touching&) const noexcept = default;
  };
  struct Anchor {
    Touching pair;
    std::uint64_t step = 0;  ///< the last one in which they touched; 0: never
    std::uint64_t met = 0;   ///< the one in which they came to rest: nothing is held in it
    odds::Vec3 points[2] = {odds::Vec3::Zero(), odds::Vec3::Zero()};  ///< one of each body, in its frame
    odds::Mat3 turned = odds::Mat3::Identity();                       ///< of the first body in the second's frame then
    double turn = 0.0;   ///< about the normal, what the first had turned against the second then
    double reach = 0.0;  ///< distance of the farthest contact from the points since then
  };
  struct Middle;
  struct Slid;

  /// That of the pair; of one that has just met its step is 0. Null: no room.
  [[nodiscard]] Anchor* find(const Touching& pair) noexcept;
  /// By how much the first body has slid against the second, no farther than bristles give: beyond that, or where the
  /// bodies have rolled on, the anchor is moved.
  [[nodiscard]] Slid follow(Anchor& anchor, const Middle& middle, double sign, double step_s) const noexcept;

  double most_slip_m_;
  std::uint64_t step_ = 64;  ///< so that an anchor of step 0 is old
  std::vector<Anchor> anchors_;
};
