#include "ode/world/solver_messages.hpp"

#include <ode/ode.h>

#include <atomic>
#include <cstdarg>
#include <cstdio>
#include <mutex>

namespace odds::ode {
namespace {

thread_local std::uint32_t* counter = nullptr;
std::atomic<dMessageFunction*> before{nullptr};  // of the program

// Written as ODE does that without a handler.
void write(int number, const char* text, va_list values) {
  if (number != 0) {
    std::fprintf(stderr, "\nODE Message %d: ", number);
  } else {
    std::fprintf(stderr, "\nODE Message: ");
  }
  std::vfprintf(stderr, text, values);
  std::fprintf(stderr, "\n");
}

void hear(int number, const char* text, va_list values) {
  if (counter != nullptr) {
    ++*counter;
  } else if (dMessageFunction* const theirs = before.load(std::memory_order_relaxed)) {
    theirs(number, text, values);
  } else {
    write(number, text, values);
  }
}

struct Holders {
  std::mutex mutex;
  int count = 0;
};

Holders& holders() noexcept {
  static Holders only;
  return only;
}

}  // namespace

MessageHandler::MessageHandler() {
  const std::lock_guard lock(holders().mutex);
  if (holders().count++ > 0) return;
  dMessageFunction* const theirs = dGetMessageHandler();
  if (theirs != &hear) before.store(theirs, std::memory_order_relaxed);  // a program may have put ours back
  dSetMessageHandler(&hear);
}

MessageHandler::~MessageHandler() {
  const std::lock_guard lock(holders().mutex);
  if (--holders().count > 0 || dGetMessageHandler() != &hear) return;
  dSetMessageHandler(before.load(std::memory_order_relaxed));
}

CountedMessages::CountedMessages() noexcept : outer_(counter) { counter = &count_; }
CountedMessages::~CountedMessages() { counter = outer_; }

}  // namespace odds::ode
