// Occupying closed descriptors, outliving limits, and the last flush.
#include "tool/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

namespace odds::tool {

void occupy_closed_streams() noexcept {
  // Opening takes the lowest free number, so each gap is filled by itself. Input and output are opened so that using
  // them shows: reading ends at once, writing to standard output fails.
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) == -1) (void)open("/dev/null", descriptor == 2 ? O_WRONLY : O_RDONLY);
  }
}

void survive_size_limits() noexcept { (void)std::signal(SIGXFSZ, SIG_IGN); }

std::optional<Error> flush_standard_output() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  const int reason = errno;
  if (flushed && std::ferror(stdout) == 0) return std::nullopt;
  return Error{"standard output", "",
               "cannot be written: " + std::generic_category().message(flushed || reason == 0 ? EIO : reason),
               "check where it goes and the space left"};
}

}  // namespace odds::tool
