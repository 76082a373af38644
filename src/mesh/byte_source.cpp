// Plain files and memory as sources of bytes.
#include "mesh/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "mesh/refusal.hpp"

namespace odds::mesh {
namespace {

std::string reason(int error_number) { return std::generic_category().message(error_number); }

class FileBytes final : public StoredBytes {
 public:
  FileBytes(int descriptor, std::uint64_t size, std::string name)
      : descriptor_(descriptor), size_(size), name_(std::move(name)) {}
  ~FileBytes() override { ::close(descriptor_); }
  [[nodiscard]] std::uint64_t size() const override { return size_; }

  std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    std::size_t done = 0;
    while (done < into.size()) {
      const ssize_t count =
          ::pread(descriptor_, into.data() + done, into.size() - done, static_cast<off_t>(offset + done));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) {
        throw Refusal{{name_, "byte " + std::to_string(offset + done), "cannot read: " + reason(errno),
                       "check the disk and try again"}};
      }
      if (count == 0) break;
      done += static_cast<std::size_t>(count);
    }
    return done;
  }

 private:
  int descriptor_;
  std::uint64_t size_;
  std::string name_;
};

class MemoryBytes final : public StoredBytes {
 public:
  explicit MemoryBytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }

  std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    if (offset >= bytes_.size()) return 0;
    const std::size_t count = std::min(into.size(), bytes_.size() - static_cast<std::size_t>(offset));
    if (count > 0) std::memcpy(into.data(), bytes_.data() + offset, count);
    return count;
  }

 private:
  std::span<const std::byte> bytes_;
};

class PlainSource final : public ByteSource {
 public:
  explicit PlainSource(const StoredBytes& stored) : stored_(stored) {}
  std::size_t read(std::span<std::byte> into) override {
    const std::size_t count = stored_.read_at(offset_, into);
    offset_ += count;
    return count;
  }
  std::uint64_t size() override { return stored_.size(); }
  [[nodiscard]] std::uint64_t size_hint() const override { return stored_.size(); }
  [[nodiscard]] bool packed() const override { return false; }

 private:
  const StoredBytes& stored_;
  std::uint64_t offset_ = 0;
};

}  // namespace

std::unique_ptr<StoredBytes> open_file(const std::filesystem::path& path) {
  // O_NONBLOCK: a pipe given by mistake must be refused below, not waited for.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    throw Refusal{{path.string(), "", "cannot open: " + reason(errno), "check the path and its permissions"}};
  }
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    throw Refusal{{path.string(), "", "not a regular file", "give the path of a mesh file"}};
  }
  return std::make_unique<FileBytes>(descriptor, static_cast<std::uint64_t>(status.st_size), path.string());
}

std::unique_ptr<StoredBytes> view_memory(std::span<const std::byte> bytes) {
  return std::make_unique<MemoryBytes>(bytes);
}

std::unique_ptr<ByteSource> stream(const StoredBytes& stored, const std::string& name,
                                   std::uint64_t max_unpacked_bytes) {
  std::array<std::byte, 2> magic{};
  const std::size_t count = stored.read_at(0, magic);
  if (count == 2 && magic[0] == std::byte{0x1f} && magic[1] == std::byte{0x8b}) {
    return stream_gzip(stored, name, max_unpacked_bytes);
  }
  return std::make_unique<PlainSource>(stored);
}

}  // namespace odds::mesh
