#include "tool/progress_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

#include "tool/one_line.hpp"

namespace odds::tool {

ProgressLine::ProgressLine(std::string_view what) : what_(on_one_line(what)), visible_(isatty(STDERR_FILENO) == 1) {
  show(0.0);
}

ProgressLine::~ProgressLine() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(double share) {
  if (!visible_) return;
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  fmt::print(stderr, "\r\033[K{} {:3.0f} %", what_, 100.0 * share);
  std::fflush(stderr);
}

}  // namespace odds::tool
