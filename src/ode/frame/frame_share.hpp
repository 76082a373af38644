// What a frame leaves to the collision under way: read by every collider, set by the frame for its own thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ode/geom/geom_data.hpp"

namespace odds::ode {

/// How far a collision came within its share.
enum class Outcome : std::uint8_t {
  unknown,   ///< nobody says: it was none with a mesh
  starved,   ///< undecided, or a hit without a contact: the share bought nothing
  enough,    ///< decided, with contacts that are of use; cut short nevertheless
  plenty,    ///< the same, but not cut short; less might have done
  carried,   ///< contacts of an earlier search, for the bodies rest: says nothing of what a search needs
  finished,  ///< proved clear, or a primitive's: less would have been nothing, more would change nothing
};

/// A bound in addition to the geoms' own budgets.
struct FrameShare {
  double us = std::numeric_limits<double>::infinity();
  unsigned long work_units = 0;  ///< 0: no limit
  bool only_held = false;        ///< no search between meshes: contacts of the last one, where the bodies are now

  // What collisions with meshes report; others report nothing.
  unsigned long spent = 0;  ///< work units
  double stall_us = 0.0;    ///< that the machine took
  int contacts = 0;
  Outcome outcome = Outcome::unknown;
  bool keeps = false;  ///< contacts of one with a body of ODE that can be given again without a search

  void report(std::uint64_t units, int given, Outcome how) noexcept {
    spent += static_cast<unsigned long>(units);
    contacts += given;
    outcome = how;
  }
};

/// The calling thread's; null outside of a frame.
inline thread_local FrameShare* current_share = nullptr;

/// Whether a share, and not the geoms' `own` budgets, ended what was cut short after `spent` units. `shared`: both.
[[nodiscard]] inline bool is_ended_by_share(const Settings& own, const Settings& shared, std::uint64_t spent) noexcept {
  constexpr std::uint64_t largest_piece = 32;  // that a search does not begin if it does not fit
  const bool units_ended = shared.work_units > 0 && spent + largest_piece >= shared.work_units;
  return units_ended ? shared.work_units != own.work_units : shared.budget_us < own.budget_us;
}

/// Of a collision with a body of ODE: what it gives is kept.
inline void note_kept() noexcept {
  if (current_share != nullptr) current_share->keeps = true;
}

[[nodiscard]] inline bool gives_only_held() noexcept { return current_share != nullptr && current_share->only_held; }

/// A geom's or a pair's settings, within the share.
[[nodiscard]] inline Settings within_share(Settings settings) noexcept {
  const FrameShare* share = current_share;
  if (share == nullptr) return settings;
  settings.budget_us = std::min(settings.budget_us, share->us);
  if (share->work_units > 0) {
    settings.work_units =
        settings.work_units > 0 ? std::min(settings.work_units, share->work_units) : share->work_units;
  }
  return settings;
}

}  // namespace odds::ode
