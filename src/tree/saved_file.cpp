#include "tree/saved_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "tree/checksum.hpp"

namespace odds::tree {
namespace {

constexpr std::size_t header_end = sizeof(SavedHeader);
/// The slab of a lane was counted from the tree's origin before, not from the lane's centre.
constexpr std::uint32_t oldest_read = 2;

template <class Number>
Number swapped(Number value) noexcept {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(Number)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

void swap_header(SavedHeader& header) noexcept {
  const auto swap = [](auto&... numbers) { ((numbers = swapped(numbers)), ...); };
  swap(header.byte_order, header.version, header.file_bytes, header.checksums_at, header.checksum_of_checksums,
       header.section_count, header.checksum);
  for (SectionEntry& entry : header.sections) {
    swap(entry.id, entry.record_bytes, entry.offset, entry.count, entry.layout);
  }
}

std::string at_byte(std::uint64_t offset) { return "byte " + std::to_string(offset); }

/// Finds what is wrong with a file, part by part; each part may rely on those before it.
class Examination {
 public:
  Examination(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[nodiscard]] std::optional<Error> examine() {
    for (const auto part : {&Examination::read_header, &Examination::check_size, &Examination::check_header,
                            &Examination::check_sections, &Examination::check_blocks}) {
      if (auto error = (this->*part)()) return error;
    }
    return std::nullopt;
  }
  [[nodiscard]] const SavedHeader& header() const noexcept { return header_; }
  [[nodiscard]] bool is_swapped() const noexcept { return swapped_; }

 private:
  using Found = std::optional<Error>;

  [[nodiscard]] Error error(std::uint64_t offset, const std::string& what,
                            const std::string& remedy = damaged_file_remedy) const {
    return {name_, at_byte(offset), what, remedy};
  }

  Found read_header() {
    if (!begins_like_saved_file(bytes_)) {
      return error(0, "not a saved hierarchy of odds", "make one with `odds build MESH -o FILE`");
    }
    if (bytes_.size() < header_end) {
      return error(bytes_.size(), "the file ends within its header of " + std::to_string(header_end) + " bytes");
    }
    std::memcpy(&header_, bytes_.data(), sizeof header_);
    swapped_ = header_.byte_order == swapped(SavedHeader::our_byte_order);
    if (swapped_) swap_header(header_);
    if (header_.byte_order != SavedHeader::our_byte_order) {
      return error(offsetof(SavedHeader, byte_order), "the mark of the byte order is neither way round");
    }
    if (header_.version > SavedHeader::newest_version || (header_.version != 0 && header_.version < oldest_read)) {
      return error(offsetof(SavedHeader, version),
                   "written in format " + std::to_string(header_.version) + " by " +
                       (header_.version < oldest_read ? "an older" : "a newer") + " odds; this one reads format " +
                       std::to_string(SavedHeader::newest_version),
                   "use that odds, or make the file anew with this one");
    }
    return std::nullopt;
  }

  Found check_size() {
    if (bytes_.size() < header_.file_bytes) {
      return error(bytes_.size(),
                   "the file ends here, but had " + std::to_string(header_.file_bytes) + " bytes: it was cut off");
    }
    if (bytes_.size() > header_.file_bytes) {
      return error(header_.file_bytes, "the file goes on where it should end");
    }
    return std::nullopt;
  }

  Found check_header() {
    const std::span covered = bytes_.first(offsetof(SavedHeader, checksum));
    if (header_.version == 0 || checksum(covered) != header_.checksum) {
      return error(0, "the header does not match its checksum: it was altered");
    }
    return std::nullopt;
  }

  Found check_sections() {
    if (header_.section_count > header_.sections.size()) {
      return error(offsetof(SavedHeader, section_count), "the header counts more arrays than it has room for");
    }
    const std::uint64_t end = header_.checksums_at;
    if (end < header_end || end > bytes_.size()) {
      return error(offsetof(SavedHeader, checksums_at), "the checksums are not within the file");
    }
    for (std::uint32_t i = 0; i < header_.section_count; ++i) {
      const SectionEntry& entry = header_.sections[i];
      const bool fits = entry.offset >= header_end && entry.offset <= end &&
                        entry.offset % SavedHeader::alignment == 0 && entry.record_bytes != 0 &&
                        entry.count <= (end - entry.offset) / entry.record_bytes;
      if (!fits) {
        return error(offsetof(SavedHeader, sections) + i * sizeof(SectionEntry), "an array is not within the file");
      }
    }
    return std::nullopt;
  }

  Found check_blocks() {
    const std::span data = bytes_.first(header_.checksums_at).subspan(header_end);
    const std::span table = bytes_.subspan(header_.checksums_at);
    const std::size_t blocks = (data.size() + SavedHeader::block_bytes - 1) / SavedHeader::block_bytes;
    if (table.size() != blocks * sizeof(std::uint64_t) || checksum(table) != header_.checksum_of_checksums) {
      return error(header_.checksums_at, "the checksums do not match their own: they were altered");
    }
    const std::size_t altered = first_bad(blocks, 16, [&](std::size_t i) { return !is_right(data, table, i); });
    if (altered == blocks) return std::nullopt;
    const std::size_t begin = header_end + altered * SavedHeader::block_bytes;
    const std::size_t end = std::min<std::size_t>(begin + SavedHeader::block_bytes, header_.checksums_at);
    return error(begin, "the bytes up to " + std::to_string(end) + " do not match their checksum: they were altered");
  }

  [[nodiscard]] bool is_right(std::span<const std::byte> data, std::span<const std::byte> table,
                              std::size_t block) const noexcept {
    const std::size_t begin = block * SavedHeader::block_bytes;
    std::uint64_t written = 0;
    std::memcpy(&written, table.data() + block * sizeof written, sizeof written);
    if (swapped_) written = swapped(written);
    return checksum(data.subspan(begin, std::min(SavedHeader::block_bytes, data.size() - begin))) == written;
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  SavedHeader header_;
  bool swapped_ = false;
};

}  // namespace

bool begins_like_saved_file(std::span<const std::byte> bytes) noexcept {
  const auto& magic = SavedHeader::right_magic;
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

bool may_be_whole(std::span<const std::byte> first, std::uint64_t size) noexcept {
  if (!begins_like_saved_file(first) || first.size() < header_end) return false;
  SavedHeader header;
  std::memcpy(&header, first.data(), sizeof header);
  if (header.byte_order == swapped(SavedHeader::our_byte_order)) swap_header(header);
  return header.file_bytes == size && checksum(first.first(offsetof(SavedHeader, checksum))) == header.checksum;
}

Result<SavedFile> SavedFile::open(KeptBytes file, const std::string& name) {
  Examination examination(file.bytes, name);
  if (auto error = examination.examine()) return *std::move(error);
  return SavedFile(std::move(file), name, examination.header(), examination.is_swapped());
}

const SectionEntry* SavedFile::find(Section id) const noexcept {
  const auto end = header_.sections.begin() + header_.section_count;
  const auto found = std::find_if(header_.sections.begin(), end, [id](const SectionEntry& entry) {
    return entry.id == static_cast<std::uint32_t>(id);
  });
  return found == end ? nullptr : &*found;
}

Error SavedFile::damaged(Section id, std::size_t record, const std::string& what) const {
  const SectionEntry* const entry = find(id);
  const std::uint64_t offset = entry == nullptr ? 0 : entry->offset + record * entry->record_bytes;
  return {name_, at_byte(offset), what, damaged_file_remedy};
}

}  // namespace odds::tree
