// What the preload library says when the program ends: pairs, latencies, contacts, what was left to ODE.
#pragma once

#include <cstdint>
#include <string>

namespace odds::preload {

/// Counts one collision. For any number of threads at once; no allocation, no lock.
void note_collision(int partner_class, std::int64_t ns, int contacts, bool by_ode) noexcept;

/// Whether there were any.
[[nodiscard]] bool has_collisions() noexcept;

/// Begins anew. Not while another thread collides.
void forget_collisions() noexcept;

/// One page of text about all collisions so far.
[[nodiscard]] std::string exit_page();

}  // namespace odds::preload
