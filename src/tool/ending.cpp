#include "tool/ending.hpp"

#include <signal.h>

#include "mesh/unfinished_file.hpp"

namespace odds::tool {
namespace {

extern "C" void end_cleanly(int signal) {
  mesh::remove_unfinished_files();
  (void)raise(signal);  // SA_RESETHAND: now it ends the program
}

}  // namespace

void leave_no_unfinished_files() noexcept {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;  // as of nohup
    struct sigaction wanted {};
    wanted.sa_handler = &end_cleanly;
    wanted.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&wanted.sa_mask);
    (void)sigaction(signal, &wanted, nullptr);
  }
}

}  // namespace odds::tool
