// Late contacts of bodies that slide, measured where they have slid to.
#pragma once

#include "odds/math/pose.hpp"
#include "odds/query/pair.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Of each late contact that has slid by some of the bodies' size (tolerances::slid_measured): a ray from its point of
/// the smaller body, along its normal, sees how deep that point lies in the other one now. So it is a true contact
/// however long ago it was found, and one that has left its surface is none, nor is one whose ray does not come to an
/// end. Its normal turns as the surface does. For what time is left.
void measure_slid(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                  Spending& spending) noexcept;

}  // namespace odds::query
