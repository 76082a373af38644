// One function per line of the host block, each from the kernel's own files.
#include "odds/realtime/host.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include "odds/realtime/clock.hpp"

namespace odds::realtime {
namespace {

using Readiness = HostLine::Readiness;

/// The files of one machine, real or made up.
class Files {
 public:
  explicit Files(std::string root) : root_(std::move(root)) {}

  [[nodiscard]] std::optional<std::string> first_line(const std::string& path) const {
    std::ifstream file(root_ + path);
    std::string line;
    if (!std::getline(file, line)) return std::nullopt;
    while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.pop_back();
    return line;
  }

  /// The value behind "key ... : value" in a file of such lines.
  [[nodiscard]] std::optional<std::string> value_of(const std::string& path, const std::string& key) const {
    std::ifstream file(root_ + path);
    std::string line;
    while (std::getline(file, line)) {
      const auto colon = line.find(':');
      if (line.rfind(key, 0) != 0 || colon == std::string::npos) continue;
      const auto begin = line.find_first_not_of(" \t", colon + 1);
      return begin == std::string::npos ? "" : line.substr(begin);
    }
    return std::nullopt;
  }

  [[nodiscard]] bool exists(const std::string& path) const { return std::ifstream(root_ + path).good(); }

 private:
  std::string root_;
};

HostLine unknown(const std::string& what) { return {what, "unknown", Readiness::unknown, ""}; }

HostLine processor(const Files& files) {
  const auto model = files.value_of("/proc/cpuinfo", "model name");
  return model ? HostLine{"processor", *model, Readiness::neutral, ""} : unknown("processor");
}

HostLine processors(const Files& files) {
  const auto online = files.first_line("/sys/devices/system/cpu/online");
  const auto isolated = files.first_line("/sys/devices/system/cpu/isolated");
  HostLine line{"processors", std::to_string(std::thread::hardware_concurrency()) + " usable", Readiness::neutral, ""};
  if (online) line.value += ", online " + *online;
  if (isolated && !isolated->empty()) {
    line.value += ", isolated " + *isolated;
    line.readiness = Readiness::good;
  } else {
    line.remark = "none is isolated (isolcpus, nohz_full): other work shares the loop's processor";
  }
  return line;
}

HostLine governor(const Files& files) {
  const auto text = files.first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (!text) return {"frequency governor", "not visible", Readiness::neutral, "the kernel or the host decides"};
  if (*text == "performance") return {"frequency governor", *text, Readiness::good, ""};
  return {"frequency governor", *text, Readiness::hinders,
          "the frequency changes under way; `cpupower frequency-set -g performance` holds it"};
}

HostLine kernel(const Files& files) {
  const auto release = files.first_line("/proc/sys/kernel/osrelease");
  return release ? HostLine{"kernel", *release, Readiness::neutral, ""} : unknown("kernel");
}

HostLine preemption(const Files& files) {
  const auto version = files.first_line("/proc/sys/kernel/version");
  if (files.first_line("/sys/kernel/realtime").value_or("0") == "1" ||
      (version && version->find("PREEMPT_RT") != std::string::npos)) {
    return {"kernel pre-emption", "PREEMPT_RT", Readiness::good, ""};
  }
  if (!version) return unknown("kernel pre-emption");
  const auto begin = version->find("PREEMPT");
  const std::string model =
      begin == std::string::npos ? "none" : version->substr(begin, version->find(' ', begin) - begin);
  return {"kernel pre-emption", model, Readiness::hinders,
          "not a real-time kernel: the kernel's own work may delay the loop by milliseconds"};
}

HostLine clock_source(const Files& files) {
  const auto current = files.first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (!current) return unknown("kernel clock source");
  if (*current == "tsc") return {"kernel clock source", *current, Readiness::good, ""};
  return {"kernel clock source", *current, Readiness::neutral, "reading the clock may cost a system call"};
}

HostLine loop_clock() {
  const ClockChoice choice = fastest_clock_choice();
  HostLine line{"clock of the queries", "CLOCK_MONOTONIC", Readiness::neutral, choice.reason};
  if (choice.time_stamp_counter) {
    char text[64];
    std::snprintf(text, sizeof text, "time-stamp counter, %.3f GHz", choice.counter_hz * 1e-9);
    line.value = text;
    line.readiness = Readiness::good;
  }
  return line;
}

HostLine limit(const std::string& what, int resource, rlim_t wanted, const std::string& consequence) {
  rlimit got{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &got) != 0) return unknown(what);
  const bool enough = got.rlim_cur == RLIM_INFINITY || got.rlim_cur >= wanted;
  return {what, got.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(got.rlim_cur),
          enough ? Readiness::good : Readiness::neutral, enough ? "" : consequence};
}

HostLine throttling(const Files& files) {
  const auto runtime = files.first_line("/proc/sys/kernel/sched_rt_runtime_us");
  const auto period = files.first_line("/proc/sys/kernel/sched_rt_period_us");
  if (!runtime || !period) return unknown("real-time throttling");
  if (*runtime == "-1") return {"real-time throttling", "off", Readiness::good, ""};
  return {"real-time throttling", *runtime + " of " + *period + " us", Readiness::neutral,
          "matters only to a real-time thread that leaves no idle time"};
}

/// The smallest quota between the process's own control group and the root, in processors.
std::optional<double> smallest_quota(const Files& files) {
  std::optional<double> smallest;
  const auto consider = [&smallest](double quota, double period) {
    if (quota > 0.0 && period > 0.0 && (!smallest || quota / period < *smallest)) smallest = quota / period;
  };
  std::string group = files.value_of("/proc/self/cgroup", "0::").value_or("");
  group = group.empty() || group[0] != ':' ? group : group.substr(1);
  while (true) {
    if (const auto text = files.first_line("/sys/fs/cgroup" + (group == "/" ? "" : group) + "/cpu.max")) {
      std::istringstream fields(*text);
      double quota = 0.0;
      double period = 0.0;
      if (fields >> quota >> period) consider(quota, period);  // "max 100000" fails to read: no quota
    }
    if (group.empty() || group == "/") break;
    group.resize(group.find_last_of('/') == std::string::npos ? 0 : group.find_last_of('/'));
  }
  const auto quota_v1 = files.first_line("/sys/fs/cgroup/cpu/cpu.cfs_quota_us");
  const auto period_v1 = files.first_line("/sys/fs/cgroup/cpu/cpu.cfs_period_us");
  if (quota_v1 && period_v1)
    consider(std::strtod(quota_v1->c_str(), nullptr), std::strtod(period_v1->c_str(), nullptr));
  return smallest;
}

HostLine quota(const Files& files) {
  const auto processors_allowed = smallest_quota(files);
  if (!processors_allowed) return {"control-group quota", "none", Readiness::good, ""};
  char text[48];
  std::snprintf(text, sizeof text, "%.2f processors", *processors_allowed);
  return {"control-group quota", text, Readiness::hinders,
          "once the quota of a period is used up, every thread stops until the next (often up to 100 ms)"};
}

HostLine virtualisation(const Files& files) {
  const auto flags = files.value_of("/proc/cpuinfo", "flags");
  const bool guest = flags && (" " + *flags + " ").find(" hypervisor ") != std::string::npos;
  const bool container = files.exists("/.dockerenv") || files.exists("/run/.containerenv");
  if (!guest && !container) return {"virtualised", "no sign of it", Readiness::good, ""};
  std::string value = guest ? "virtual machine" : "container";
  if (guest && container) value += " and container";
  if (const auto vendor = files.first_line("/sys/class/dmi/id/sys_vendor"); guest && vendor)
    value += " (" + *vendor + ")";
  if (!guest) return {"virtualised", value, Readiness::neutral, ""};
  return {"virtualised", value, Readiness::hinders,
          "the host may take the processor away for milliseconds, unseen by this system's scheduler"};
}

HostLine load(const Files& files) {
  const auto text = files.first_line("/proc/loadavg");
  if (!text) return unknown("load");
  std::istringstream fields(*text);
  std::string one;
  std::string five;
  std::string fifteen;
  fields >> one >> five >> fifteen;
  HostLine line{"load (1, 5, 15 min)", one + ", " + five + ", " + fifteen, Readiness::neutral, ""};
  const double usable = std::max(1.0, static_cast<double>(std::thread::hardware_concurrency()));
  double running = 0.0;  // not by strtod: a program may have set a locale whose numbers have commas
  std::from_chars(one.data(), one.data() + one.size(), running);
  if (running > usable) {
    line.readiness = Readiness::hinders;
    line.remark = "more runnable programs than processors: end the others, or ask for real-time priority";
  }
  return line;
}

HostLine build() {
  std::string value;
#if defined(__clang__)
  value = "clang " __clang_version__;
#else
  value = "g++ " __VERSION__;
#endif
#if defined(NDEBUG)
  return {"build", value + ", optimised, without assertions", Readiness::good, ""};
#else
  return {"build", value + ", with assertions", Readiness::hinders, "a debug build: its times say nothing"};
#endif
}

}  // namespace

const char* name(HostLine::Readiness readiness) noexcept {
  switch (readiness) {
    case Readiness::good:
      return "good";
    case Readiness::hinders:
      return "hinders";
    case Readiness::unknown:
      return "unknown";
    case Readiness::neutral:
      break;
  }
  return "neutral";
}

std::vector<HostLine> describe_host(const std::string& root) {
  const Files files(root);
  return {processor(files),
          processors(files),
          governor(files),
          virtualisation(files),
          kernel(files),
          preemption(files),
          clock_source(files),
          loop_clock(),
          quota(files),
          throttling(files),
          limit("limit rtprio", RLIMIT_RTPRIO, 1, "SCHED_FIFO needs it, or CAP_SYS_NICE"),
          limit("limit memlock (bytes)", RLIMIT_MEMLOCK, RLIM_INFINITY, "locking all memory needs it, or CAP_IPC_LOCK"),
          load(files),
          build()};
}

}  // namespace odds::realtime
