// Boost.Context does the switching; sanitizers have to be told of it.
#include "realtime/fiber.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <boost/context/fiber.hpp>
#include <boost/context/preallocated.hpp>
#include <boost/context/stack_context.hpp>
#include <cstring>
#include <new>
#include <utility>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ODDS_FIBER_ASAN
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define ODDS_FIBER_ASAN
#endif
#ifdef ODDS_FIBER_ASAN
#include <sanitizer/asan_interface.h>
#endif
#ifdef ODDS_FIBER_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace odds::realtime {
namespace {

std::size_t rounded_to_pages(std::size_t bytes, std::size_t page) noexcept { return (bytes + page - 1) / page * page; }

/// The stack is its owner's: whoever ends leaves it as it is.
struct KeepsStack {
  void deallocate(boost::context::stack_context&) noexcept {}
};

}  // namespace

/// The two sides of a switch, and what sanitizers want to know at each.
struct Fiber::Switch {
  explicit Switch(std::size_t wanted)
      : page(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))), bytes(rounded_to_pages(wanted, page)) {
    void* const mapped =
        mmap(nullptr, page + bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    bottom = static_cast<std::byte*>(mapped) + page;
    if (mprotect(mapped, page, PROT_NONE) != 0) {
      munmap(mapped, page + bytes);
      throw std::bad_alloc();
    }
#ifdef ODDS_FIBER_ASAN
    // The frames of a stack that was here before may have left their marks: unmapping does not take them away.
    __asan_unpoison_memory_region(bottom, bytes);
#endif
    std::memset(bottom, 0, bytes);
#ifdef ODDS_FIBER_TSAN
    inside_fiber = __tsan_create_fiber(0);
#endif
  }
  ~Switch() {
#ifdef ODDS_FIBER_TSAN
    __tsan_destroy_fiber(inside_fiber);
#endif
    munmap(bottom - page, page + bytes);
  }
  Switch(const Switch&) = delete;
  Switch& operator=(const Switch&) = delete;

  void will_enter() noexcept {
#ifdef ODDS_FIBER_ASAN
    __sanitizer_start_switch_fiber(&outside_fake_stack, bottom, bytes);
#endif
#ifdef ODDS_FIBER_TSAN
    outside_fiber = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(inside_fiber, 0);
#endif
  }
  void has_entered() noexcept {
#ifdef ODDS_FIBER_ASAN
    __sanitizer_finish_switch_fiber(inside_fake_stack, &outside_bottom, &outside_bytes);
#endif
  }
  void will_leave([[maybe_unused]] bool for_good) noexcept {
#ifdef ODDS_FIBER_ASAN
    __sanitizer_start_switch_fiber(for_good ? nullptr : &inside_fake_stack, outside_bottom, outside_bytes);
    if (for_good) inside_fake_stack = nullptr;
#endif
#ifdef ODDS_FIBER_TSAN
    __tsan_switch_to_fiber(outside_fiber, 0);
#endif
  }
  void has_left() noexcept {
#ifdef ODDS_FIBER_ASAN
    __sanitizer_finish_switch_fiber(outside_fake_stack, nullptr, nullptr);
#endif
  }

  std::size_t page;
  std::size_t bytes;  ///< of the stack, without the page below it
  std::byte* bottom = nullptr;
  Body body = nullptr;
  void* argument = nullptr;
  boost::context::fiber inside;   ///< where the body waits
  boost::context::fiber outside;  ///< where who resumed it waits
#ifdef ODDS_FIBER_ASAN
  void* inside_fake_stack = nullptr;
  void* outside_fake_stack = nullptr;
  const void* outside_bottom = nullptr;
  std::size_t outside_bytes = 0;
#endif
#ifdef ODDS_FIBER_TSAN
  void* inside_fiber = nullptr;
  void* outside_fiber = nullptr;
#endif
};

Fiber::Fiber(std::size_t stack_bytes) : switch_(std::make_unique<Switch>(stack_bytes)) {}
Fiber::~Fiber() = default;

void Fiber::start(Body body, void* argument) noexcept {
  Switch& both = *switch_;
  both.body = body;
  both.argument = argument;
  done_ = false;
  boost::context::stack_context stack;
  stack.size = both.bytes;
  stack.sp = both.bottom + both.bytes;
  both.inside = boost::context::fiber(std::allocator_arg, boost::context::preallocated(stack.sp, stack.size, stack),
                                      KeepsStack{}, [this](boost::context::fiber&& caller) noexcept {
                                        Switch& own = *switch_;
                                        own.has_entered();
                                        own.outside = std::move(caller);
                                        own.body(own.argument);
                                        done_ = true;
                                        own.will_leave(true);
                                        return std::move(own.outside);
                                      });
}

void Fiber::resume() noexcept {
  switch_->will_enter();
  boost::context::fiber back = std::move(switch_->inside).resume();
  switch_->has_left();
  switch_->inside = std::move(back);
}

void Fiber::yield() noexcept {
  switch_->will_leave(false);
  boost::context::fiber caller = std::move(switch_->outside).resume();
  switch_->has_entered();
  switch_->outside = std::move(caller);
}

}  // namespace odds::realtime
