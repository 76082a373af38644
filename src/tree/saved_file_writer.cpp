#include "tree/saved_file_writer.hpp"

#include "tree/checksum.hpp"

namespace odds::tree {
namespace {

constexpr std::array<std::byte, SavedHeader::alignment> zeros{};

/// Zeros that bring `size` to a multiple of the alignment.
std::span<const std::byte> padding_after(std::size_t size) noexcept {
  const std::size_t beyond = size % SavedHeader::alignment;
  return std::span(zeros).first(beyond == 0 ? 0 : SavedHeader::alignment - beyond);
}

void put(std::ostream& out, std::span<const std::byte> bytes) {
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

void SavedFileWriter::write(std::ostream& out) const {
  SavedHeader header;
  BlockChecksums blocks(SavedHeader::block_bytes);
  std::size_t offset = sizeof header;
  for (const Array& array : arrays_) {
    SectionEntry& entry = header.sections[header.section_count++];
    entry = array.entry;
    entry.offset = offset;
    const auto padding = padding_after(array.bytes.size());
    blocks.add(array.bytes);
    blocks.add(padding);
    offset += array.bytes.size() + padding.size();
  }
  const std::vector<std::uint64_t> table = blocks.finish();
  header.checksums_at = offset;
  header.file_bytes = offset + std::as_bytes(std::span(table)).size();
  header.checksum_of_checksums = checksum(std::as_bytes(std::span(table)));
  const std::span header_bytes = std::as_bytes(std::span(&header, 1));
  header.checksum = checksum(header_bytes.first(offsetof(SavedHeader, checksum)));

  put(out, header_bytes);
  for (const Array& array : arrays_) {
    put(out, array.bytes);
    put(out, padding_after(array.bytes.size()));
  }
  put(out, std::as_bytes(std::span(table)));
}

}  // namespace odds::tree
