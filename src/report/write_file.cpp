// Putting a text into its file, whole or not at all.
#include "report/write_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace odds::report {

std::optional<Error> write_file(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path part = path.string() + ".part" + std::to_string(getpid());
  errno = 0;
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (file && std::rename(part.c_str(), path.c_str()) == 0) return std::nullopt;
  const int reason = errno;
  std::remove(part.c_str());
  return Error{path.string(), "", std::string("cannot be written: ") + std::strerror(reason != 0 ? reason : EIO),
               "check the directory's permissions and the space left"};
}

}  // namespace odds::report
