// What ODE says while a world steps: counted, for writing it would be a system call.
#pragma once

#include <cstdint>

namespace odds::ode {

/// As long as one lives, what ODE says goes through this library. What it says in a thread that counts stops there;
/// all else goes to the handler that the program had before, or is written as ODE writes it. The last one gives that
/// handler back, unless the program has set another.
class MessageHandler {
 public:
  MessageHandler();
  ~MessageHandler();
  MessageHandler(const MessageHandler&) = delete;
  MessageHandler& operator=(const MessageHandler&) = delete;
};

/// While it lives, this thread counts.
class CountedMessages {
 public:
  CountedMessages() noexcept;
  ~CountedMessages();
  CountedMessages(const CountedMessages&) = delete;
  CountedMessages& operator=(const CountedMessages&) = delete;

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }

 private:
  std::uint32_t count_ = 0;
  std::uint32_t* outer_;
};

}  // namespace odds::ode
