// A call that can be left in the middle and taken up again later: it has a stack of its own.
#pragma once

#include <cstddef>
#include <memory>

namespace odds::realtime {

/// Runs a function in pieces: it goes on when `resume` is called and comes back where it calls `yield`. A switch takes
/// some 10 ns (Boost.Context): no system call, lock or allocation. Not thread-safe, but each piece may run in another
/// thread; the function may keep no address of a thread-local variable over a `yield`. It must not throw.
class Fiber {
 public:
  using Body = void (*)(void* argument) noexcept;

  /// Takes the stack and touches it, so that no page of it is missing later; below it is one that may not be touched.
  /// Throws bad_alloc.
  explicit Fiber(std::size_t stack_bytes);
  /// Precondition: is_done().
  ~Fiber();
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  /// `body(argument)` begins at the next `resume`. Precondition: is_done().
  void start(Body body, void* argument) noexcept;
  /// Goes on until the body yields or ends. Precondition: not is_done().
  void resume() noexcept;
  /// From within the body: back to who resumed it.
  void yield() noexcept;
  /// Nothing was started, or it has come to its end.
  [[nodiscard]] bool is_done() const noexcept { return done_; }

 private:
  struct Switch;
  std::unique_ptr<Switch> switch_;
  bool done_ = true;
};

}  // namespace odds::realtime
