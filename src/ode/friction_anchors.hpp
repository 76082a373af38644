// What bodies that touch have slid since they came to rest, and how the solver is asked to take it back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "odds/math/types.hpp"
#include "odds/ode/odds_friction.h"

/// A table of a fixed size, by the unordered pair of geoms. World frame, metres, radians.
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
  /// Of the first geom's body against the second's.
  struct Slid {
    odds::Vec3 by = odds::Vec3::Zero();    ///< at the middle of their contacts
    odds::Vec3 turn = odds::Vec3::Zero();  ///< about the normal there
  };
  struct Anchor {
    Touching pair;
    std::uint64_t step = 0;  ///< the last one in which they touched; 0: never
    Slid slid;
  };

  /// That of the pair; where there is none yet, one that begins now. Null: no room.
  [[nodiscard]] Anchor* find(const Touching& pair) noexcept;

  double most_slip_m_;
  std::uint64_t step_ = 2;  ///< so that an anchor of step 0 is old
  std::vector<Anchor> anchors_;
};
