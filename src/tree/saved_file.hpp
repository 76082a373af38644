// The container of saved hierarchies: a header, arrays of records, checksums. What the arrays mean is not known here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/mesh/shared_array.hpp"
#include "tree/first_bad.hpp"
#include "tree/kept_bytes.hpp"
#include "tree/record_layout.hpp"

namespace odds::tree {

/// The arrays by their numbers in files; numbers are never given again.
enum class Section : std::uint32_t {
  facts = 1,
  name = 2,
  vertices = 3,
  triangles = 4,
  wide_nodes = 5,
  wide_leaves = 6,
  statistics = 7,
  statistics_at = 8,
  nodes = 9,
  corners = 10,
  order = 11,
};

/// One array in the file: `count` records of `record_bytes` from byte `offset` on, a multiple of 64.
struct SectionEntry {
  std::uint32_t id = 0;
  std::uint32_t record_bytes = 0;
  std::uint64_t offset = 0;
  std::uint64_t count = 0;
  std::uint64_t layout = 0;  ///< layout_code of the records
};

/// The first bytes of a file. Numbers of header, records and checksums are in the byte order of the writer, which
/// `byte_order` tells. Between the arrays stand zeros; from `checksums_at` to the end a checksum for each block.
struct SavedHeader {
  static constexpr std::array<unsigned char, 8> right_magic = {0x89, 'O', 'D', 'D', 'S', '\r', '\n', 0x1A};
  static constexpr std::uint32_t our_byte_order = 0x01020304;
  static constexpr std::uint32_t newest_version = 2;
  static constexpr std::size_t block_bytes = std::size_t{1} << 18U;
  static constexpr std::size_t alignment = 64;

  std::array<unsigned char, 8> magic = right_magic;
  std::uint32_t byte_order = our_byte_order;
  std::uint32_t version = newest_version;
  std::uint64_t file_bytes = 0;
  std::uint64_t checksums_at = 0;
  std::uint64_t checksum_of_checksums = 0;
  std::uint32_t section_count = 0;
  std::uint32_t unused = 0;
  std::array<SectionEntry, 16> sections;
  std::uint64_t unused_too = 0;
  std::uint64_t checksum = 0;  ///< of all bytes of the header before it
};
static_assert(sizeof(SavedHeader) == 576);

/// A file whose header and checksums have been found right. Thread-safe to read from.
class SavedFile {
 public:
  /// `name` stands in errors, which name the byte.
  [[nodiscard]] static Result<SavedFile> open(KeptBytes file, const std::string& name);

  [[nodiscard]] bool has(Section id) const noexcept { return find(id) != nullptr; }

  /// The records of a section: in the file itself, or a copy where the byte order is not ours. Floating-point numbers
  /// are finite and no more than `most_in` their record. A section that is not there has no records.
  template <class T>
  [[nodiscard]] Result<mesh::SharedArray<T>> array(Section id) const;

  /// An error about a record of a section.
  [[nodiscard]] Error damaged(Section id, std::size_t record, const std::string& what) const;

 private:
  SavedFile(KeptBytes file, std::string name, const SavedHeader& header, bool swapped)
      : file_(std::move(file)), name_(std::move(name)), header_(header), swapped_(swapped) {}

  [[nodiscard]] const SectionEntry* find(Section id) const noexcept;
  [[nodiscard]] std::span<const std::byte> bytes_of(const SectionEntry& entry) const noexcept {
    return file_.bytes.subspan(entry.offset, entry.count * entry.record_bytes);
  }

  KeptBytes file_;
  std::string name_;
  SavedHeader header_;
  bool swapped_;
};

/// Whether these may be the first bytes of a saved hierarchy.
[[nodiscard]] bool begins_like_saved_file(std::span<const std::byte> bytes) noexcept;

/// Whether a file of `size` bytes that begins with these may be a whole one: its header is right, and of that size.
/// Another may be of any size, and is refused without a look at the rest.
[[nodiscard]] bool may_be_whole(std::span<const std::byte> first, std::uint64_t size) noexcept;

/// What to do about a file that is not as it was written.
inline constexpr const char* damaged_file_remedy = "copy it again from where it is whole, or make it anew";

template <class T>
Result<mesh::SharedArray<T>> SavedFile::array(Section id) const {
  const SectionEntry* const entry = find(id);
  if (entry == nullptr || entry->count == 0) return mesh::SharedArray<T>();
  if (entry->record_bytes != sizeof(T) || entry->layout != layout_code<T>()) {
    return Error{name_, "byte " + std::to_string(entry->offset),
                 "its records of kind " + std::to_string(entry->id) + " have another layout than this odds reads",
                 "make the file anew with this odds"};
  }
  const std::span<const std::byte> bytes = bytes_of(*entry);
  mesh::SharedArray<T> records;
  if (swapped_) {
    std::vector<T> copy(entry->count);
    const std::span raw(reinterpret_cast<std::byte*>(copy.data()), bytes.size());
    std::copy(bytes.begin(), bytes.end(), raw.begin());
    swap_records(raw, layout_of<T>());
    records = std::move(copy);
  } else {
    // The writer put such records here, at an address that suits them.
    records = {{reinterpret_cast<const T*>(bytes.data()), entry->count}, file_.keeper};
  }
  const auto is_bad = [values = records.span()](std::size_t i) { return !is_within(most_in<T>, values[i]); };
  const std::size_t bad = first_bad(records.size(), 8192, is_bad);
  if (bad != records.size()) {
    return damaged(id, bad, is_finite(records[bad]) ? "a number is out of range" : "a number is not finite");
  }
  return records;
}

}  // namespace odds::tree
