// When a search has to end that looks at the clock as it goes.
#pragma once

#include "odds/query/contact_patch.hpp"
#include "ode/collide/limit.hpp"

namespace odds::ode {

/// The end of a share of a collision's time, as searches ask for it at each node.
class EndOfShare {
 public:
  /// From a tree's root to a triangle; a search that may be a collision's only one goes so far in any case.
  static constexpr int to_a_triangle = 8;

  /// Looks at the clock when it is asked for the `every`-th time.
  EndOfShare(const Limit& limit, double share, int sure_nodes, int every = 2) noexcept
      : limit_(limit), share_(share), sure_nodes_(sure_nodes), every_(every) {}
  [[nodiscard]] bool is_there() noexcept {
    return ++asked_ > sure_nodes_ && asked_ % every_ == 0 && limit_.time_is_up(share_);
  }
  [[nodiscard]] query::Deadline deadline() noexcept {
    return {[](void* self) noexcept { return static_cast<EndOfShare*>(self)->is_there(); }, this};
  }

 private:
  const Limit& limit_;
  double share_;
  int sure_nodes_;
  int every_;
  int asked_ = 0;
};

}  // namespace odds::ode
