// Gzip as a source of bytes: unpacked piece by piece, so that memory does not depend on the unpacked size.
#include <zlib.h>

#include <algorithm>
#include <new>
#include <optional>
#include <vector>

#include "mesh/byte_source.hpp"
#include "mesh/refusal.hpp"

namespace odds::mesh {
namespace {

// zlib's memory comes from operator new, like everything else here: one hook on it sees all that reading allocates.
voidpf allocate(voidpf, uInt count, uInt size) {
  return ::operator new(static_cast<std::size_t>(count) * size, std::nothrow);
}
void release(voidpf, voidpf memory) { ::operator delete(memory); }

constexpr std::size_t piece_bytes = std::size_t{1} << 16;

/// One pass over the packed bytes. Several members one after the other are one stream, as for gunzip.
class Inflater {
 public:
  Inflater(const StoredBytes& stored, std::string name, std::uint64_t max_unpacked_bytes)
      : stored_(stored),
        name_(std::move(name)),
        max_unpacked_bytes_(max_unpacked_bytes),
        packed_(static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, stored.size()))) {
    zlib_.zalloc = allocate;
    zlib_.zfree = release;
    constexpr int gzip_only = 16 + MAX_WBITS;
    if (inflateInit2(&zlib_, gzip_only) != Z_OK) {
      throw Refusal{{name_, "", "not enough memory to unpack gzip", "free some memory"}};
    }
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&zlib_); }

  std::size_t read(std::span<std::byte> into) {
    zlib_.next_out = reinterpret_cast<Bytef*>(into.data());
    zlib_.avail_out = static_cast<uInt>(into.size());
    while (zlib_.avail_out > 0 && !finished_) step();
    const std::size_t count = into.size() - zlib_.avail_out;
    unpacked_ += count;
    if (unpacked_ > max_unpacked_bytes_) {
      refuse("the file unpacks to more than " + std::to_string(max_unpacked_bytes_) + " bytes",
             "raise max_unpacked_bytes if this is really a mesh");
    }
    return count;
  }

 private:
  void step() {
    if (zlib_.avail_in == 0) fetch();
    if (member_ended_) {
      begin_member();
      return;
    }
    if (zlib_.avail_in == 0) {
      refuse("the packed data ends early", "the file is truncated: copy or download it again");
    }
    const int status = inflate(&zlib_, Z_NO_FLUSH);
    if (status == Z_STREAM_END) {
      member_ended_ = true;
    } else if (status == Z_MEM_ERROR) {
      refuse("not enough memory to unpack gzip", "free some memory");
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      const std::string detail = zlib_.msg != nullptr ? zlib_.msg : "invalid data";
      refuse("the packed data is damaged (" + detail + ")", "copy or download the file again, or pack it again");
    }
  }

  void begin_member() {
    if (zlib_.avail_in == 0) {
      finished_ = true;
      return;
    }
    if (*zlib_.next_in != 0x1f) {
      refuse("there are bytes after the end of the packed data", "cut them off or pack the mesh again");
    }
    inflateReset(&zlib_);
    member_ended_ = false;
  }

  void fetch() {
    const std::size_t count = stored_.read_at(fetched_, packed_);
    fetched_ += count;
    zlib_.next_in = reinterpret_cast<Bytef*>(packed_.data());
    zlib_.avail_in = static_cast<uInt>(count);
  }

  [[noreturn]] void refuse(std::string what, std::string remedy) const {
    throw Refusal{
        {name_, "byte " + std::to_string(fetched_ - zlib_.avail_in) + " (packed)", std::move(what), std::move(remedy)}};
  }

  const StoredBytes& stored_;
  std::string name_;
  std::uint64_t max_unpacked_bytes_;
  std::vector<std::byte> packed_;
  z_stream zlib_{};
  std::uint64_t fetched_ = 0;
  std::uint64_t unpacked_ = 0;
  bool member_ended_ = false;
  bool finished_ = false;
};

class GzipSource final : public ByteSource {
 public:
  GzipSource(const StoredBytes& stored, const std::string& name, std::uint64_t max_unpacked_bytes)
      : stored_(stored),
        name_(name),
        max_unpacked_bytes_(max_unpacked_bytes),
        pass_(stored, name, max_unpacked_bytes) {}

  std::size_t read(std::span<std::byte> into) override { return pass_.read(into); }

  std::uint64_t size() override {
    if (!size_) {
      // The length that gzip stores is modulo 2^32, of the last member only, and may lie: count.
      Inflater measuring(stored_, name_, max_unpacked_bytes_);
      std::vector<std::byte> piece(piece_bytes);
      std::uint64_t total = 0;
      for (std::size_t count = measuring.read(piece); count > 0; count = measuring.read(piece)) total += count;
      size_ = total;
    }
    return *size_;
  }
  [[nodiscard]] std::uint64_t size_hint() const override { return stored_.size() * 1032; }  // deflate's greatest ratio
  [[nodiscard]] bool packed() const override { return true; }

 private:
  const StoredBytes& stored_;
  std::string name_;
  std::uint64_t max_unpacked_bytes_;
  Inflater pass_;
  std::optional<std::uint64_t> size_;
};

}  // namespace

std::unique_ptr<ByteSource> stream_gzip(const StoredBytes& stored, const std::string& name,
                                        std::uint64_t max_unpacked_bytes) {
  return std::make_unique<GzipSource>(stored, name, max_unpacked_bytes);
}

}  // namespace odds::mesh
