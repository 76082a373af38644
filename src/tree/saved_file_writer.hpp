// Writes the container of saved hierarchies.
#pragma once

#include <cstddef>
#include <ostream>
#include <span>
#include <vector>

#include "tree/record_layout.hpp"
#include "tree/saved_file.hpp"

namespace odds::tree {

/// Collects arrays, which must stay until `write`, and writes them in the order in which they came.
class SavedFileWriter {
 public:
  template <class T>
  void add(Section id, std::span<const T> records) {
    arrays_.push_back(
        {{static_cast<std::uint32_t>(id), sizeof(T), 0, records.size(), layout_code<T>()}, std::as_bytes(records)});
  }

  /// Everything, from front to back; whether it could be written is the stream's state. Two passes over the arrays.
  void write(std::ostream& out) const;

 private:
  struct Array {
    SectionEntry entry;
    std::span<const std::byte> bytes;
  };

  std::vector<Array> arrays_;  ///< at most as many as the header has room for
};

}  // namespace odds::tree
