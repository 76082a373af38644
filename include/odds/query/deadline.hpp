// Who is asked, during a piece of work, whether its time is up.
#pragma once

namespace odds::query {

/// Says whether the time is up. Null: never. Polled every microsecond or two. `expired` must not allocate, lock or throw.
struct Deadline {
  bool (*expired)(void* self) noexcept = nullptr;
  void* self = nullptr;

  [[nodiscard]] bool operator()() const noexcept { return expired != nullptr && expired(self); }
};

}  // namespace odds::query
