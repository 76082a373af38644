// Progress of a job that consists of several parts, one line on the terminal.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tool/progress_line.hpp"

namespace odds::tool {

class BuildProgress {
 public:
  /// Shows a part's share; another part replaces the line of the one before.
  void show(std::string_view what, double share) {
    if (what != part_) {
      line_.reset();
      part_ = what;
      line_.emplace(part_);
    }
    line_->show(share);
  }
  /// Wipes the line.
  void done() {
    line_.reset();
    part_.clear();
  }

 private:
  std::string part_;
  std::optional<ProgressLine> line_;
};

}  // namespace odds::tool
