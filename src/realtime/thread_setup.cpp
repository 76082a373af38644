// One function per wish; each reads back what the kernel made of it.
#include "odds/realtime/thread_setup.hpp"

#include <alloca.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace odds::realtime {
namespace {

using Outcome = SetupLine::Outcome;

std::string errno_text(int code) { return std::strerror(code); }

std::string limit_text(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0) return "unknown";
  return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

/// Whether the process holds a capability, by the kernel's own list.
bool has_capability(unsigned bit) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.rfind("CapEff:", 0) != 0) continue;
    std::istringstream digits(line.substr(7));
    std::uint64_t mask = 0;
    digits >> std::hex >> mask;
    return ((mask >> bit) & 1U) != 0;
  }
  return false;
}

SetupLine set_fifo(int priority) {
  SetupLine line{"real-time priority SCHED_FIFO " + std::to_string(priority), Outcome::refused, ""};
  if (priority < sched_get_priority_min(SCHED_FIFO) || priority > sched_get_priority_max(SCHED_FIFO)) {
    line.detail = "not a priority between 1 and 99";
    return line;
  }
  sched_param wanted{};
  wanted.sched_priority = priority;
  if (const int code = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted); code != 0) {
    line.detail = errno_text(code) + "; the limit rtprio is " + limit_text(RLIMIT_RTPRIO) +
                  ": raise it in /etc/security/limits.d, or grant CAP_SYS_NICE";
    return line;
  }
  int policy = 0;
  sched_param got{};
  if (pthread_getschedparam(pthread_self(), &policy, &got) != 0 || policy != SCHED_FIFO ||
      got.sched_priority != priority) {
    line.detail = "the kernel accepted the call and did not apply it";
    return line;
  }
  line.outcome = Outcome::granted;
  std::ifstream runtime_file("/proc/sys/kernel/sched_rt_runtime_us");
  if (long runtime_us = 0; runtime_file >> runtime_us && runtime_us >= 0) {
    line.detail = "the kernel still takes real-time threads off the processor after " + std::to_string(runtime_us) +
                  " us of any period that they fill (sched_rt_runtime_us)";
  }
  return line;
}

SetupLine lock_memory() {
  SetupLine line{"memory locked", Outcome::refused, ""};
  constexpr unsigned cap_ipc_lock = 14;
  rlimit limit{};
  const bool limited =
      getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && !has_capability(cap_ipc_lock);
  // Under a limit, locking future pages too would make later allocations of the whole process fail.
  const int flags = limited ? MCL_CURRENT : MCL_CURRENT | MCL_FUTURE;
  if (mlockall(flags) != 0) {
    line.detail = errno_text(errno) + "; the limit memlock is " + limit_text(RLIMIT_MEMLOCK) +
                  " bytes: raise it in /etc/security/limits.d, or grant CAP_IPC_LOCK";
    return line;
  }
  line.outcome = limited ? Outcome::partly : Outcome::granted;
  line.detail = limited ? "present pages only, because the limit memlock is " + limit_text(RLIMIT_MEMLOCK) + " bytes"
                        : "present and future pages of the process";
  return line;
}

SetupLine pin(int cpu) {
  SetupLine line{"pinned to processor " + std::to_string(cpu), Outcome::refused, ""};
  if (cpu < 0 || cpu >= CPU_SETSIZE) {
    line.detail = "no such processor";
    return line;
  }
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  CPU_SET(static_cast<unsigned>(cpu), &wanted);
  if (sched_setaffinity(0, sizeof wanted, &wanted) != 0) {
    line.detail = errno == EINVAL ? "no such processor, or not one that this process may use" : errno_text(errno);
    return line;
  }
  cpu_set_t got;
  CPU_ZERO(&got);
  if (sched_getaffinity(0, sizeof got, &got) != 0 || !CPU_EQUAL(&wanted, &got)) {
    line.detail = "the kernel accepted the call and did not apply it";
    return line;
  }
  line.outcome = Outcome::granted;
  return line;
}

SetupLine set_timer_slack(std::uint64_t slack_ns) {
  SetupLine line{"timer slack " + std::to_string(slack_ns) + " ns", Outcome::refused, ""};
  if (slack_ns == 0) {
    line.detail = "0 would mean the default; ask for 1";
    return line;
  }
  if (prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(slack_ns), 0UL, 0UL, 0UL) != 0) {
    line.detail = errno_text(errno);
    return line;
  }
  const int got = prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);
  if (got >= 0 && static_cast<std::uint64_t>(got) <= slack_ns) {
    line.outcome = Outcome::granted;
    if (got == 0) line.detail = "0 ns, as for every real-time thread";
  } else {
    line.detail = "the kernel keeps " + std::to_string(got) + " ns";
  }
  return line;
}

/// Bytes below the current frame that the thread may still use, less a margin for what runs afterwards.
std::size_t stack_left() {
  constexpr std::size_t margin = std::size_t{64} * 1024;
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  void* lowest = nullptr;
  std::size_t size = 0;
  const int code = pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  if (code != 0) return 0;
  const char here = 0;
  const auto left = reinterpret_cast<std::uintptr_t>(&here) - reinterpret_cast<std::uintptr_t>(lowest);
  return left > margin && left <= size ? left - margin : 0;
}

[[gnu::noinline]] void touch_stack(std::size_t bytes) {
  auto* block = static_cast<volatile unsigned char*>(alloca(bytes));
  // From the top downwards: the main thread's stack grows only next to its present end.
  for (std::size_t offset = bytes; offset > 0; offset -= offset < 1024 ? offset : 1024) block[offset - 1] = 0;
}

SetupLine prefault_stack(std::size_t bytes) {
  SetupLine line{"stack touched in advance, " + std::to_string(bytes / 1024) + " KiB", Outcome::refused, ""};
  const std::size_t left = stack_left();
  const std::size_t touched = bytes < left ? bytes : left;
  if (touched == 0) {
    line.detail = "the thread's stack leaves no room";
    return line;
  }
  touch_stack(touched);
  line.outcome = touched == bytes ? Outcome::granted : Outcome::partly;
  if (touched != bytes) line.detail = "the thread's stack left room for " + std::to_string(touched / 1024) + " KiB";
  return line;
}

}  // namespace

const char* name(SetupLine::Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::granted:
      return "granted";
    case Outcome::partly:
      return "granted in part";
    case Outcome::refused:
      break;
  }
  return "refused";
}

std::string SetupLine::text() const {
  const std::string result = asked + ": " + name(outcome);
  return detail.empty() ? result : result + ": " + detail;
}

std::vector<SetupLine> set_up_this_thread(const ThreadRequest& request) {
  std::vector<SetupLine> lines;
  if (request.fifo_priority) lines.push_back(set_fifo(*request.fifo_priority));
  if (request.lock_memory) lines.push_back(lock_memory());
  if (request.cpu) lines.push_back(pin(*request.cpu));
  if (request.timer_slack_ns) lines.push_back(set_timer_slack(*request.timer_slack_ns));
  if (request.prefault_stack_bytes > 0) lines.push_back(prefault_stack(request.prefault_stack_bytes));
  return lines;
}

}  // namespace odds::realtime
