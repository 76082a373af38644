#include "query/memory/scratch_pool.hpp"

#include <algorithm>
#include <map>
#include <thread>

namespace odds::query {

std::shared_ptr<ScratchPool> ScratchPool::of(const Capacities& capacities) {
  static std::mutex registering;
  static std::map<Capacities, std::weak_ptr<ScratchPool>> registry;
  const std::lock_guard lock(registering);
  std::weak_ptr<ScratchPool>& known = registry[capacities];
  std::shared_ptr<ScratchPool> pool = known.lock();
  if (!pool) {
    pool = std::make_shared<ScratchPool>(capacities);
    known = pool;
  }
  return pool;
}

ScratchPool::ScratchPool(const Capacities& capacities)
    : capacities_(capacities),
      places_(capacities.most > 0 ? capacities.most : std::max(most_threads, std::thread::hardware_concurrency())) {
  scratches_.reserve(places_.size());
}

void ScratchPool::add_pair() {
  const std::lock_guard lock(changing_);
  if (scratches_.size() < std::min<std::size_t>(pairs_ + 1, places_.size())) {
    scratches_.push_back(std::make_unique<Scratch>(capacities_.queue, capacities_.hits, capacities_.stack_bytes));
    places_[scratches_.size() - 1].free.store(scratches_.back().get(), std::memory_order_release);
    made_.store(static_cast<std::uint32_t>(scratches_.size()), std::memory_order_release);
    free_.fetch_add(1, std::memory_order_relaxed);
  }
  ++pairs_;
}

void ScratchPool::remove_pair() noexcept {
  const std::lock_guard lock(changing_);
  --pairs_;
}

ScratchPool::Loan ScratchPool::borrow(std::uint32_t& last) noexcept {
  for (std::uint32_t i = last;;) {
    std::atomic<Scratch*>& place = places_[i].free;
    if (place.load(std::memory_order_relaxed) != nullptr) {
      if (Scratch* const scratch = place.exchange(nullptr, std::memory_order_acquire)) {
        last = i;
        return {place, *scratch};
      }
    }
    i = i + 1 < size() ? i + 1 : 0;
  }
}

Scratch* ScratchPool::take(std::uint32_t& last) noexcept {
  if (!has_free()) return nullptr;
  const std::uint32_t count = size();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at = (last + i) % count;
    if (places_[at].free.load(std::memory_order_relaxed) == nullptr) continue;
    if (Scratch* const scratch = places_[at].free.exchange(nullptr, std::memory_order_acquire)) {
      free_.fetch_sub(1, std::memory_order_relaxed);
      last = at;
      return scratch;
    }
  }
  return nullptr;
}

void ScratchPool::give_back(Scratch& scratch, std::uint32_t last) noexcept {
  places_[last].free.store(&scratch, std::memory_order_release);
  free_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace odds::query
