// Carries records from a real-time loop to a writer of normal priority, without ever holding up the loop.
#pragma once

#include <sched.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "odds/realtime/spsc_ring.hpp"

namespace odds::realtime {

/// A ring between one pushing thread and the writer thread that it owns. The ring is allocated and its pages are
/// touched at construction; `push` then costs some ten nanoseconds, never allocates, locks, waits or makes a system
/// call, and on a full ring drops the record and counts it. The writer looks at the ring every few milliseconds (waking
/// it would cost the loop a system call) and hands what it found to the sink, in order.
///
/// Construct it before the loop's thread takes real-time priority or is pinned: the writer asks for normal priority,
/// but the processors that it may use are inherited.
template <class Record>
requires std::is_trivially_copyable_v<Record>
class Recorder {
 public:
  /// Called by the writer thread only, never with an empty span. Must not throw.
  using Sink = std::function<void(std::span<const Record>)>;

  /// `capacity` >= 1 records are held at least; one second of a loop is ample.
  Recorder(std::size_t capacity, Sink sink, std::chrono::microseconds look_every = std::chrono::milliseconds(2))
      : ring_(capacity), sink_(std::move(sink)), look_every_(look_every) {
    batch_.reserve(capacity);
    writer_ = std::thread([this] { write_until_finished(); });
  }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder() { finish(); }

  /// From one thread only. False if the ring was full and the record was dropped. Not after finish().
  bool push(const Record& record) noexcept {
    if (ring_.try_push(record)) return true;
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);  // one pusher: no race
    return false;
  }

  /// Records lost because the ring was full. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  /// Hands everything pushed so far to the sink and ends the writer. By the pushing thread, or after it ended. May be
  /// called again.
  void finish() {
    if (!writer_.joinable()) return;
    finished_.store(true, std::memory_order_release);
    writer_.join();
  }

 private:
  void write_until_finished() {
    const sched_param normal{};
    sched_setscheduler(0, SCHED_OTHER, &normal);  // lowering one's priority is always allowed
    while (true) {
      const bool last =
          finished_.load(std::memory_order_acquire);  // read before the ring: nothing pushed earlier is missed
      drain();
      if (last) return;
      std::this_thread::sleep_for(look_every_);
    }
  }

  void drain() {
    Record record;
    do {
      batch_.clear();
      while (batch_.size() < batch_.capacity() && ring_.try_pop(record)) batch_.push_back(record);
      if (!batch_.empty()) sink_(batch_);
    } while (!batch_.empty());
  }

  SpscRing<Record> ring_;
  Sink sink_;
  std::chrono::microseconds look_every_;
  std::vector<Record> batch_;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<bool> finished_{false};
  std::thread writer_;
};

}  // namespace odds::realtime
