// Memory that a run works in and leaves nothing in: pairs share it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "odds/query/contact_patch.hpp"
#include "query/search/bucket_queue.hpp"
#include "realtime/fiber.hpp"

namespace odds::query {

/// What a search from the roots and a contact patch need, about a megabyte. No run reads what another one has left.
struct Scratch {
  Scratch(std::uint32_t queue_capacity, std::uint32_t hit_capacity, std::uint32_t stack_bytes)
      : queue(queue_capacity), patches(hit_capacity) {
    if (stack_bytes > 0) fiber.emplace(stack_bytes);
  }
  BucketQueue queue;
  PatchBuilder patches;
  std::optional<realtime::Fiber> fiber;  ///< for runs that are left in the middle
};

/// As many scratches as pairs can run at once: one for each pair, but no more than threads may be there. A thousand
/// pairs that run one after another use a single one, which therefore stays in the caches.
class ScratchPool {
 public:
  struct Capacities {
    std::uint32_t queue = 0;
    std::uint32_t hits = 0;
    std::uint32_t stack_bytes = 0;  ///< of a fiber; 0: none
    std::uint32_t most = 0;         ///< scratches; 0: as many as there may be threads
    auto operator<=>(const Capacities&) const = default;
  };
  /// The pool of all pairs with such capacities. May throw bad_alloc. Any thread.
  [[nodiscard]] static std::shared_ptr<ScratchPool> of(const Capacities& capacities);
  explicit ScratchPool(const Capacities& capacities);

  /// A pair more or less. The first may throw bad_alloc; then nothing has changed. Any thread.
  void add_pair();
  void remove_pair() noexcept;
  [[nodiscard]] std::uint32_t size() const noexcept { return made_.load(std::memory_order_acquire); }

  /// A scratch of one's own until the end of a scope, or none.
  class Loan {
   public:
    Loan() = default;
    Loan(std::atomic<Scratch*>& place, Scratch& scratch) noexcept : place_(&place), scratch_(&scratch) {}
    /// Of one that is the borrower's own.
    explicit Loan(Scratch& own) noexcept : scratch_(&own) {}
    ~Loan() {
      if (place_ != nullptr) place_->store(scratch_, std::memory_order_release);
    }
    Loan(Loan&& other) noexcept : place_(std::exchange(other.place_, nullptr)), scratch_(other.scratch_) {}
    Loan& operator=(Loan&& other) noexcept {
      std::swap(place_, other.place_);
      std::swap(scratch_, other.scratch_);
      return *this;
    }
    [[nodiscard]] explicit operator bool() const noexcept { return scratch_ != nullptr; }
    /// Precondition: there is one.
    [[nodiscard]] Scratch* operator->() const noexcept { return scratch_; }

   private:
    std::atomic<Scratch*>* place_ = nullptr;
    Scratch* scratch_ = nullptr;
  };
  /// One that is free: the `last` one that this pair had, if it is. Lock-free: there is one for each pair that runs.
  /// Only of more threads at once than `most_threads` one waits until another is done. Precondition: a pair was added.
  [[nodiscard]] Loan borrow(std::uint32_t& last) noexcept;
  /// The same for longer than a scope, at `last`; null if none is free.
  [[nodiscard]] Scratch* take(std::uint32_t& last) noexcept;
  /// Whether `take` would probably find one. Of a pool of which nothing is borrowed.
  [[nodiscard]] bool has_free() const noexcept { return free_.load(std::memory_order_relaxed) > 0; }
  /// Gives back what `take` gave at `last`.
  void give_back(Scratch& scratch, std::uint32_t last) noexcept;

  static constexpr std::uint32_t most_threads = 32;  ///< or as many as the processor has

 private:
  struct alignas(64) Place {  // a cache line each: threads do not wait for each other's
    std::atomic<Scratch*> free{nullptr};
  };

  Capacities capacities_;
  std::vector<Place> places_;
  std::atomic<std::uint32_t> made_{0};
  std::atomic<std::int32_t> free_{0};  ///< made, and not taken: asked in each run, which has no time for 64 places
  std::mutex changing_;                ///< guards what follows
  std::uint32_t pairs_ = 0;
  std::vector<std::unique_ptr<Scratch>> scratches_;
};

/// A pair's part in the pool.
class SharedScratch {
 public:
  explicit SharedScratch(const ScratchPool::Capacities& capacities) : pool_(ScratchPool::of(capacities)) {
    pool_->add_pair();
  }
  /// Of a pair that is always told what to use.
  SharedScratch() = default;
  ~SharedScratch() {
    if (pool_) pool_->remove_pair();
  }
  SharedScratch(const SharedScratch&) = delete;
  SharedScratch& operator=(const SharedScratch&) = delete;
  [[nodiscard]] ScratchPool::Loan borrow() noexcept {
    return own_ != nullptr ? ScratchPool::Loan(*own_) : pool_->borrow(last_);
  }
  /// From now on the pair works in `own`.
  void use(Scratch* own) noexcept { own_ = own; }

 private:
  std::shared_ptr<ScratchPool> pool_;
  std::uint32_t last_ = 0;
  Scratch* own_ = nullptr;
};

}  // namespace odds::query
