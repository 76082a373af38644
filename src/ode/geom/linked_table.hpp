// Chains of links that stay where they are, for tables that are read without a lock while others write.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

namespace odds::ode {

/// Values by a number that is not 0, whose lower bits are as good as random. `find` takes no lock, and may run while
/// another thread inserts or removes other values: a link that is taken out keeps its place in memory, and what it
/// leads to, so that who stands on it comes to the end of the chain. It is used again in the same chain only, whose
/// beginning whoever stands on it then comes to. Writers take turns by a lock of the owner's. Does not own the values.
template <class Value, std::size_t bucket_count>
class LinkedTable {
 public:
  LinkedTable() = default;
  LinkedTable(const LinkedTable&) = delete;
  LinkedTable& operator=(const LinkedTable&) = delete;
  ~LinkedTable() {
    for (Bucket& bucket : buckets_) {
      for (Link* all = bucket.all; all != nullptr;) delete std::exchange(all, all->made_before);
    }
  }

  [[nodiscard]] Value* find(std::uint64_t key) const noexcept {
    for (const Link* link = bucket_of(key).first.load(std::memory_order_acquire); link != nullptr;
         link = link->next.load(std::memory_order_acquire)) {
      if (link->key.load(std::memory_order_acquire) == key) return link->value.load(std::memory_order_acquire);
    }
    return nullptr;
  }

  /// Takes memory for one more of this key's chain, if there is none left, so that `insert` cannot fail. May throw
  /// std::bad_alloc.
  void reserve(std::uint64_t key) {
    Bucket& bucket = bucket_of(key);
    if (bucket.unused != nullptr) return;
    auto link = std::make_unique<Link>();
    link->made_before = bucket.all;
    bucket.all = bucket.unused = link.release();
  }
  /// Preconditions: reserved, and no such key in the table.
  void insert(std::uint64_t key, Value* value) noexcept {
    Bucket& bucket = bucket_of(key);
    Link* const link = std::exchange(bucket.unused, bucket.unused->next_unused);
    link->value.store(value, std::memory_order_release);
    link->next.store(bucket.first.load(std::memory_order_relaxed), std::memory_order_release);
    link->key.store(key, std::memory_order_release);  // last: whoever stands on it sees all or nothing
    bucket.first.store(link, std::memory_order_release);
  }
  /// The value that was there, or null.
  Value* remove(std::uint64_t key) noexcept {
    Bucket& bucket = bucket_of(key);
    std::atomic<Link*>* leads_here = &bucket.first;
    while (Link* const link = leads_here->load(std::memory_order_relaxed)) {
      if (link->key.load(std::memory_order_relaxed) == key) {
        leads_here->store(link->next.load(std::memory_order_relaxed), std::memory_order_release);
        link->key.store(0, std::memory_order_release);
        link->next_unused = std::exchange(bucket.unused, link);
        return link->value.exchange(nullptr, std::memory_order_acq_rel);
      }
      leads_here = &link->next;
    }
    return nullptr;
  }
  /// Takes all values out and calls `each` with each. Not beside readers.
  template <class Each>
  void remove_all(Each each) noexcept {
    for (Bucket& bucket : buckets_) {
      while (const Link* const link = bucket.first.load(std::memory_order_relaxed)) {
        each(remove(link->key.load(std::memory_order_relaxed)));
      }
    }
  }

 private:
  struct Link {
    std::atomic<std::uint64_t> key{0};
    std::atomic<Value*> value{nullptr};
    std::atomic<Link*> next{nullptr};
    Link* next_unused = nullptr;
    Link* made_before = nullptr;
  };
  struct Bucket {
    std::atomic<Link*> first{nullptr};
    Link* unused = nullptr;
    Link* all = nullptr;
  };

  [[nodiscard]] const Bucket& bucket_of(std::uint64_t key) const noexcept { return buckets_[key % bucket_count]; }
  [[nodiscard]] Bucket& bucket_of(std::uint64_t key) noexcept { return buckets_[key % bucket_count]; }

  std::array<Bucket, bucket_count> buckets_;
};

}  // namespace odds::ode
