// Many pairs of meshes in one space: what a frame budget is for.
#pragma once

#include <cmath>
#include <vector>

#include "odds/mesh/made/torus_knot.hpp"
#include "odds/ode/odds_frame.h"
#include "ode/ode_fixture.hpp"

namespace odds::test {

/// A pair of a crowd, and what its collision gave in a frame.
struct CrowdPair {
  dGeomID a = nullptr;
  dGeomID b = nullptr;
  bool touches = false;  ///< by a search without a limit
  int served = 0;        ///< frames in which its callback ran
  int contacts = 0;      ///< of the last frame
  bool right = false;    ///< the last frame's verdict was the truth
};

/// Pairs of torus knots, each pair apart from the others: every fifth is interlocked, the others lie on each other, and
/// hardly touch or do not. They need no bodies.
class Crowd {
 public:
  Crowd(dSpaceID space, int pairs, std::uint32_t segments = 96) {
    const auto shape = shape_of(mesh::made::TorusKnot{.along = segments});
    const double size = shape->mesh().size();
    for (int i = 0; i < pairs; ++i) {
      CrowdPair pair;
      pair.a = mesh_geom(shape, space);
      pair.b = mesh_geom(shape, space);
      // Bodies at rest cost next to nothing in the second frame; these are to cost the same in every one.
      dGeomOddsMeshSetMethod(pair.a, ODDS_METHOD_TIME_CRITICAL);
      dGeomOddsMeshSetMethod(pair.b, ODDS_METHOD_TIME_CRITICAL);
      const double x = 4.0 * size * (i % 20);
      const double y = 4.0 * size * (i / 20);
      dGeomSetPosition(pair.a, x, y, 0.0);
      // Interlocked, or one above the other so that boxes overlap and surfaces hardly do.
      const bool interlocked = i % 5 == 0;
      rotate(pair.b, interlocked ? Vec3(1.0, 0.4, 0.3).normalized() : Vec3::UnitZ().eval(), 1.1 * i);
      dGeomSetPosition(pair.b, x, y, interlocked ? 0.04 : 0.098);
      oddsPreparePair(pair.a, pair.b);
      pair.touches = !collide(pair.a, pair.b).empty();
      pairs_.push_back(pair);
    }
  }

  /// One frame: every pair's callback collides it once.
  void run(dSpaceID space, oddsFrameBudgetID budget) {
    for (CrowdPair& pair : pairs_) pair.contacts = 0;
    oddsSpaceCollide(space, this, &Crowd::near, budget);
  }

  [[nodiscard]] const std::vector<CrowdPair>& pairs() const { return pairs_; }
  [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }  ///< of the last frame
  void begin_frame() { order_.clear(); }

 private:
  static void near(void* self, dGeomID a, dGeomID b) {
    auto& crowd = *static_cast<Crowd*>(self);
    for (std::size_t i = 0; i < crowd.pairs_.size(); ++i) {
      CrowdPair& pair = crowd.pairs_[i];
      if ((pair.a != a || pair.b != b) && (pair.a != b || pair.b != a)) continue;
      dContactGeom contacts[8];
      pair.contacts = dCollide(a, b, 8, contacts, sizeof(dContactGeom));
      pair.right = (pair.contacts > 0) == pair.touches;
      ++pair.served;
      crowd.order_.push_back(i);
      return;
    }
  }

  std::vector<CrowdPair> pairs_;
  std::vector<std::size_t> order_;
};

}  // namespace odds::test
