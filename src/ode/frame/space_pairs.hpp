// The pairs of geoms that a space's broad phase finds, those of the spaces inside of it too.
#pragma once

#include <ode/ode.h>

namespace odds::ode {

/// dSpaceCollide whose callback sees pairs of geoms only, each once: spaces inside of `space` are searched, each once,
/// unless they are disabled. The callback must not change any of the spaces. Allocates nothing itself.
void for_each_pair(dSpaceID space, void* data, dNearCallback* callback) noexcept;

}  // namespace odds::ode
