// One line on stderr that says what is being done and how far it is; silent unless stderr is a terminal.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace odds::tool {

class ProgressLine {
 public:
  explicit ProgressLine(std::string_view what);
  /// Wipes the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows a share in [0, 1], at most ten times a second.
  void show(double share);

 private:
  std::string what_;
  bool visible_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace odds::tool
