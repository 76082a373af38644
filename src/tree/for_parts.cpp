#include "odds/tree/for_parts.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace odds::tree {

std::size_t threads_for(std::size_t tasks) noexcept {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, std::max<std::size_t>(1, tasks));
}

void for_parts(std::size_t count, std::size_t part, const std::function<void(std::size_t, std::size_t)>& task) {
  const std::size_t parts = (count + part - 1) / part;
  std::atomic<std::size_t> next{0};
  on_threads(threads_for(parts), [&] {
    for (std::size_t i = next++; i < parts; i = next++) task(i * part, std::min(count, (i + 1) * part));
  });
}

void on_threads(std::size_t threads, const std::function<void()>& task) {
  std::exception_ptr first_error;
  std::mutex mutex;
  const auto guarded = [&]() noexcept {
    try {
      task();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!first_error) first_error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    helpers.reserve(threads - 1);
    try {
      while (helpers.size() + 1 < threads) helpers.emplace_back(guarded);
    } catch (const std::system_error&) {
      // No more threads are to be had: fewer do the work.
    }
    guarded();
  }
  if (first_error) std::rethrow_exception(first_error);
}

}  // namespace odds::tree
