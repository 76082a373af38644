// The corner that is deepest in the other body, beside contacts that are guessed where surfaces cross.
#pragma once

#include "query/memory/pair_memory.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Searches for the corner that is farthest along the way in which contacts pushed last, and measures how deep it is;
/// if there is time for one of both only, the next run goes on. False: there was no time for either.
bool look_for_corner(const math::Pose& pose_b_in_a, Pair::Implementation& pair, Spending& spending) noexcept;

/// Looks, if this run has not yet, and puts what is known of corners before the answer's contacts.
void support_by_corners(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                        Spending& spending) noexcept;

}  // namespace odds::query
