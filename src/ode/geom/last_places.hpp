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
/// one partner takes the place of another, or has its address, or threads overwrite each other's. No locks.
class LastPlaces {
 public:
  static constexpr std::size_t most = 8;

  /// Writes what is known of the partner. Returns how many; check that the mesh has such. What was written of a place
  /// that is not there any more is a matter of chance.
  [[nodiscard]] std::size_t of(dGeomID partner, std::span<std::uint32_t, most> places) const noexcept {
    const Entry& entry = entries_[index_of(partner)];
    if (entry.partner.load(std::memory_order_relaxed) != partner) return 0;
    const std::size_t count = std::min<std::size_t>(entry.count.load(std::memory_order_relaxed), most);
    for (std::size_t i = 0; i < count; ++i) places[i] = entry.places[i].load(std::memory_order_relaxed);
    return count;
  }
  /// Another number after each note.
  [[nodiscard]] std::uint32_t turn(dGeomID partner) const noexcept {
    return entries_[index_of(partner)].turn.load(std::memory_order_relaxed);
  }
  void note(dGeomID partner, std::span<const std::uint32_t> places) noexcept {
    Entry& entry = entries_[index_of(partner)];
    entry.turn.store(entry.turn.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    const std::size_t count = std::min(places.size(), most);
    for (std::size_t i = 0; i < count; ++i) entry.places[i].store(places[i], std::memory_order_relaxed);
    entry.count.store(static_cast<std::uint32_t>(count), std::memory_order_relaxed);
    entry.partner.store(partner, std::memory_order_relaxed);
  }

 private:
  struct Entry {
    std::atomic<dGeomID> partner{nullptr};
    std::atomic<std::uint32_t> turn{0};
    std::atomic<std::uint32_t> count{0};
    std::array<std::atomic<std::uint32_t>, most> places{};
  };
  static constexpr int bits = 6;

  [[nodiscard]] static std::size_t index_of(dGeomID partner) noexcept {
    const std::uint64_t hash = std::uint64_t{reinterpret_cast<std::uintptr_t>(partner)} * 0x9E3779B97F4A7C15U;
    return hash >> (64 - bits);  // Fibonacci hashing
  }

  std::array<Entry, std::size_t{1} << bits> entries_;
};

}  // namespace odds::ode
