#include "tree/kept_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

namespace odds::tree {
namespace {

std::string reason(int error_number) { return std::generic_category().message(error_number); }

class Descriptor {
 public:
  // O_NONBLOCK: a pipe given by mistake must be refused, not waited for.
  explicit Descriptor(const std::filesystem::path& path)
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

struct alignas(64) Line {
  std::byte bytes[64];
};

#if defined(MAP_POPULATE)
constexpr int all_pages = MAP_POPULATE;
#else
constexpr int all_pages = 0;
#endif

bool is_worth_reading(int file, std::uint64_t size, const WorthReading& worth) {
  std::vector<std::byte> first(worth.first_bytes);
  const ssize_t count = ::pread(file, first.data(), first.size(), 0);
  return count > 0 && worth.is_worth(std::span(first).first(static_cast<std::size_t>(count)), size);
}

}  // namespace

Result<KeptBytes> map_file(const std::filesystem::path& path, const WorthReading& worth) {
  const Descriptor file(path);
  if (file.number() < 0) {
    return Error{path.string(), "", "cannot open: " + reason(errno), "check the path and its permissions"};
  }
  struct stat status {};
  if (::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return Error{path.string(), "", "not a regular file", "give the path of a saved hierarchy"};
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return KeptBytes{};
  const int flags = MAP_PRIVATE | (is_worth_reading(file.number(), size, worth) ? all_pages : 0);
  void* const memory = ::mmap(nullptr, size, PROT_READ, flags, file.number(), 0);
  if (memory == MAP_FAILED) {
    return Error{path.string(), "", "cannot be mapped into memory: " + reason(errno), "free some memory and try again"};
  }
  std::shared_ptr<const void> keeper(memory, [size](void* mapped) { ::munmap(mapped, size); });
  return KeptBytes{{static_cast<const std::byte*>(memory), size}, std::move(keeper)};
}

KeptBytes copy_bytes(std::span<const std::byte> bytes) {
  auto lines = std::make_shared<std::vector<Line>>((bytes.size() + sizeof(Line) - 1) / sizeof(Line));
  if (!bytes.empty()) std::memcpy(lines->data(), bytes.data(), bytes.size());
  const std::byte* first = reinterpret_cast<const std::byte*>(lines->data());
  return {{first, bytes.size()}, std::move(lines)};
}

}  // namespace odds::tree
