// Saved shapes as bytes in memory, and what it takes to alter them as somebody would who knows the format.
#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "odds/query/saved_shape.hpp"
#include "query/shape_data.hpp"
#include "tree/checksum.hpp"
#include "tree/saved_facts.hpp"
#include "tree/saved_file.hpp"

namespace odds::testing {

inline std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

inline std::string saved_bytes(const query::Shape& shape) {
  std::ostringstream out;
  query::write_shape(shape, out);
  return out.str();
}

inline Result<std::shared_ptr<const query::Shape>> load(const std::string& bytes) {
  return query::load_shape(bytes_of(bytes), "saved");
}

inline tree::SavedHeader header_of(const std::string& bytes) {
  tree::SavedHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

inline void put_header(std::string& bytes, const tree::SavedHeader& header) {
  std::memcpy(bytes.data(), &header, sizeof header);
}

/// Where the records of a section begin; 0 if there are none.
inline std::size_t offset_of(const std::string& bytes, tree::Section id) {
  for (const tree::SectionEntry& entry : header_of(bytes).sections) {
    if (entry.id == static_cast<std::uint32_t>(id)) return entry.offset;
  }
  return 0;
}

/// The checksums of the blocks, as they stand at the end of a file.
inline std::string block_table(const std::string& bytes, const tree::SavedHeader& header) {
  tree::BlockChecksums blocks(tree::SavedHeader::block_bytes);
  blocks.add(bytes_of(bytes).first(header.checksums_at).subspan(sizeof header));
  const std::vector<std::uint64_t> table = blocks.finish();
  std::string text(table.size() * sizeof(std::uint64_t), '\0');
  if (!text.empty()) std::memcpy(text.data(), table.data(), text.size());
  return text;
}

/// Makes all checksums right again, as far as the header still tells where they are.
inline void reseal(std::string& bytes) {
  tree::SavedHeader header = header_of(bytes);
  if (header.checksums_at >= sizeof header && header.checksums_at <= bytes.size()) {
    const std::string table = block_table(bytes, header);
    const std::size_t room = std::min(table.size(), bytes.size() - header.checksums_at);
    std::memcpy(bytes.data() + header.checksums_at, table.data(), room);
    header.checksum_of_checksums = tree::checksum(bytes_of(bytes).subspan(header.checksums_at));
    put_header(bytes, header);
  }
  header.checksum = tree::checksum(bytes_of(bytes).first(offsetof(tree::SavedHeader, checksum)));
  put_header(bytes, header);
}

namespace detail {

using Layouts = std::map<std::uint64_t, std::span<const tree::Field>>;

template <class... T>
void add_layouts(Layouts& layouts) {
  ((layouts[tree::layout_code<T>()] = tree::layout_of<T>()), ...);
}

template <class... V>
Layouts all_layouts(const query::Volumes<V...>&) {
  Layouts layouts;
  add_layouts<typename tree::Hierarchy<V>::Node...>(layouts);
  add_layouts<char, std::uint32_t, Vec3, mesh::Triangle, tree::TriangleCorners, tree::NodeStatistics, tree::WideNode,
              tree::WideLeaf, tree::SavedFacts>(layouts);
  return layouts;
}

inline void reverse(std::string& bytes, std::size_t at, std::size_t size) {
  std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
}

}  // namespace detail

/// The same file as a machine of the other byte order would have written it.
inline std::string other_byte_order(std::string bytes) {
  const auto layouts = detail::all_layouts(query::GenericVolumes());
  tree::SavedHeader header = header_of(bytes);
  for (std::uint32_t i = 0; i < header.section_count; ++i) {
    const tree::SectionEntry& entry = header.sections[i];
    std::size_t at = entry.offset;
    for (std::uint64_t record = 0; record < entry.count; ++record) {
      for (const tree::Field& field : layouts.at(entry.layout)) {
        const std::size_t size = tree::bytes_of(field.scalar);
        for (std::uint32_t k = 0; k < field.count; ++k, at += size) detail::reverse(bytes, at, size);
      }
    }
  }
  std::string table = block_table(bytes, header);
  for (std::size_t at = 0; at < table.size(); at += 8) detail::reverse(table, at, 8);
  bytes.replace(header.checksums_at, table.size(), table);
  header.checksum_of_checksums = tree::checksum(bytes_of(table));
  put_header(bytes, header);
  for (const std::size_t at : {8U, 12U, 40U, 44U}) detail::reverse(bytes, at, 4);
  for (const std::size_t at : {16U, 24U, 32U}) detail::reverse(bytes, at, 8);
  for (std::size_t i = 0; i < header.sections.size(); ++i) {
    const std::size_t at = 48 + i * sizeof(tree::SectionEntry);
    for (const std::size_t k : {0U, 4U}) detail::reverse(bytes, at + k, 4);
    for (const std::size_t k : {8U, 16U, 24U}) detail::reverse(bytes, at + k, 8);
  }
  const std::size_t end = offsetof(tree::SavedHeader, checksum);
  const std::uint64_t seal = tree::checksum(bytes_of(bytes).first(end));
  std::memcpy(bytes.data() + end, &seal, sizeof seal);
  detail::reverse(bytes, end, sizeof seal);
  return bytes;
}

}  // namespace odds::testing
