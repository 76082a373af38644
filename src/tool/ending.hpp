// What is left when a signal ends the program.
#pragma once

namespace odds::tool {

/// Has the signals that end a program, where they are not ignored, take files away first that are not whole. The
/// program still ends by the signal.
void leave_no_unfinished_files() noexcept;

}  // namespace odds::tool
