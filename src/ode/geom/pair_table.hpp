// Workspaces of pairs of geoms, found without a lock by the unordered pair of geom numbers.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "odds/query/pair.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/geom/held_contacts.hpp"
#include "ode/geom/linked_table.hpp"

namespace odds::ode {

/// The memory of one pair. `a` is the geom that was created first, whatever the order of any call.
struct PairEntry {
  GeomData* a = nullptr;
  GeomData* b = nullptr;
  std::optional<query::Pair> pair;  ///< empty: making it failed, remembered so that the loop does not try again
  oddsAnswer last = {};             ///< with g1 = a
  HeldContacts held;
  bool answered = false;
  bool touched = false;  ///< the last query gave a contact, and did not prove them apart
  static constexpr std::uint32_t long_ago = 1U << 16U;
  std::uint32_t runs_undecided = long_ago;  ///< since the last decided hit; `long_ago` after a decision that it is none
  math::Pose met_at;                        ///< B in A in the last decided hit
  std::atomic<std::uint64_t> asked_in{0};   ///< the last broad phase that asked; 0: none
  std::atomic<bool> busy{false};            ///< in use by a thread
};

/// `find` runs in the loop, without a lock, also while another thread prepares or forgets pairs of other geoms. `forget`
/// must not run while another thread collides pairs of that geom (destroying a geom in use is the caller's error in ODE
/// too).
class PairTable {
 public:
  [[nodiscard]] PairEntry* find(const GeomData& x, const GeomData& y) const noexcept;

  struct Made {
    PairEntry* entry = nullptr;  ///< null: no memory even for the entry (last error set)
    bool inserted = false;       ///< false: was there before
  };
  /// Finds or makes the entry and its query::Pair. `warmed`: and runs a new one as far as its memory goes. If the pair
  /// cannot be made the entry stays without it and the last error says why.
  Made prepare(GeomData& x, GeomData& y, bool warmed) noexcept;

  /// Frees every entry of this geom.
  void forget(GeomData& geom) noexcept;

 private:
  [[nodiscard]] static std::uint64_t key_of(const GeomData& a, const GeomData& b) noexcept;

  LinkedTable<PairEntry, 8192> entries_;
  std::mutex writers_;
};

[[nodiscard]] PairTable& pair_table() noexcept;

/// The workspace of two geoms whose meshes have collided; null where they have not, or one is no mesh of this library.
/// Sets no error.
[[nodiscard]] const PairEntry* answered_pair(dGeomID g1, dGeomID g2) noexcept;

}  // namespace odds::ode
