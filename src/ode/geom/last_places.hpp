// Where of a mesh a partner was met when it was asked about last.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace odds::ode {

/// Some triangles, or corners of them, by partner. A search that starts from them leaves out most of the tree, and
/// where its time is up it has something that is nearly right. Each is looked at anew, so that nothing is wrong where
/// one partner takes the place of another, or has its address, or threads overwrite each other's. Which partners are
/// known depends on the order in which they were met, not on their addresses: those differ from run to run. No locks.
class LastPlaces {
 public:
  static constexpr std::size_t most = 8;
  static constexpr std::size_t most_partners = 64;

  /// Writes what is known of the partner. Returns how many; check that the mesh has such. What was written of a place
  /// that is not there any more is a matter of chance.
  [[nodiscard]] std::size_t of(dGeomID partner, std::span<std::uint32_t, most> places) const noexcept {
    const std::size_t index = index_of(partner);
    if (index == most_partners) return 0;
    const Entry& entry = entries_[index];
    const std::size_t count = std::min<std::size_t>(entry.count.load(std::memory_order_relaxed), most);
    for (std::size_t i = 0; i < count; ++i) places[i] = entry.places[i].load(std::memory_order_relaxed);
    return count;
  }
  /// Another number after each note; 0 of a partner that is not known.
  [[nodiscard]] std::uint32_t turn(dGeomID partner) const noexcept {
    const std::size_t index = index_of(partner);
    return index == most_partners ? 0 : entries_[index].turn.load(std::memory_order_relaxed);
  }
  void note(dGeomID partner, std::span<const std::uint32_t> places) noexcept {
    std::size_t index = index_of(partner);
    if (index == most_partners && (index = index_for_another()) == most_partners) return;
    Entry& entry = entries_[index];
    const bool is_known = partners_[index].load(std::memory_order_relaxed) == partner;
    entry.turn.store(is_known ? entry.turn.load(std::memory_order_relaxed) + 1 : 1, std::memory_order_relaxed);
    const std::size_t count = std::min(places.size(), most);
    for (std::size_t i = 0; i < count; ++i) entry.places[i].store(places[i], std::memory_order_relaxed);
    entry.count.store(static_cast<std::uint32_t>(count), std::memory_order_relaxed);
    partners_[index].store(partner, std::memory_order_relaxed);
  }

 private:
  struct Entry {
    std::atomic<std::uint32_t> turn{0};
    std::atomic<std::uint32_t> count{0};
    std::array<std::atomic<std::uint32_t>, most> places{};
  };

  /// most_partners: it is not known. They come one after the other and none is taken out, so that few are looked at.
  [[nodiscard]] std::size_t index_of(dGeomID partner) const noexcept {
    for (std::size_t i = 0; i < most_partners; ++i) {
      const dGeomID known = partners_[i].load(std::memory_order_relaxed);
      if (known == partner) return i;
      if (known == nullptr) break;
    }
    return most_partners;
  }
  /// most_partners: none for this one. If each took the place of the oldest, of more partners than there is room for
  /// none would be known when its turn comes again.
  [[nodiscard]] std::size_t index_for_another() noexcept {
    constexpr std::uint32_t stays = 16;
    const std::uint32_t others = others_.fetch_add(1, std::memory_order_relaxed);
    if (others < most_partners) return others;
    return others % stays == 0 ? others / stays % most_partners : most_partners;
  }

  std::array<std::atomic<dGeomID>, most_partners> partners_{};  ///< null: no more
  std::array<Entry, most_partners> entries_;
  std::atomic<std::uint32_t> others_{0};  ///< how often one was noted that was not known
};

}  // namespace odds::ode
