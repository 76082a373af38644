// Where a reader's bytes come from: a file or memory, plain or unpacked on the fly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace odds::mesh {

/// Bytes as stored, at any offset: lets a packed file be measured in one pass and parsed in another.
class StoredBytes {
 public:
  StoredBytes() = default;
  StoredBytes(const StoredBytes&) = delete;
  StoredBytes& operator=(const StoredBytes&) = delete;
  virtual ~StoredBytes() = default;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `into` from `offset`; returns fewer bytes only at the end. Throws Refusal if the system cannot read.
  virtual std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const = 0;
};

/// Opens a regular file. Throws Refusal if there is none or it cannot be opened.
std::unique_ptr<StoredBytes> open_file(const std::filesystem::path& path);
/// Looks at memory that must outlive the result.
std::unique_ptr<StoredBytes> view_memory(std::span<const std::byte> bytes);

/// A stream of bytes from front to back whose length can be asked for beforehand.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;
  /// Fills `into`; returns fewer bytes only at the end. Throws Refusal on unreadable or damaged input.
  virtual std::size_t read(std::span<std::byte> into) = 0;
  /// Length of the whole stream; for packed input it costs a pass over it, once.
  virtual std::uint64_t size() = 0;
  /// A cheap upper hint for the size of buffers.
  [[nodiscard]] virtual std::uint64_t size_hint() const = 0;
  [[nodiscard]] virtual bool packed() const = 0;
};

/// Streams `stored` as it is, or unpacked if it begins like gzip. Unpacking more than `max_unpacked_bytes` is refused.
/// `stored` must outlive the result; `name` stands in errors.
std::unique_ptr<ByteSource> stream(const StoredBytes& stored, const std::string& name,
                                   std::uint64_t max_unpacked_bytes);

/// The gzip half of stream(), for inputs known to begin with gzip's magic bytes.
std::unique_ptr<ByteSource> stream_gzip(const StoredBytes& stored, const std::string& name,
                                        std::uint64_t max_unpacked_bytes);

}  // namespace odds::mesh
