// Work on ranges by all processors, with results that do not depend on how many there are.
#pragma once

#include <cstddef>
#include <functional>

namespace odds::tree {

/// Threads for so many independent tasks: no more than the machine has processors, at least 1.
[[nodiscard]] std::size_t threads_for(std::size_t tasks) noexcept;

/// Calls task(begin, end) on parts of [0, count), on as many threads as the machine has when there is enough to do.
/// The parts do not depend on the number of threads. What a task throws is thrown again here once all threads are done.
void for_parts(std::size_t count, std::size_t part, const std::function<void(std::size_t, std::size_t)>& task);

/// Calls task() at the same time on `threads` threads, the calling one among them, and waits for all. What a task
/// throws is thrown again here.
void on_threads(std::size_t threads, const std::function<void()>& task);

}  // namespace odds::tree
