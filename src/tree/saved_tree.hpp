// Trees as arrays of a saved file.
#pragma once

#include "odds/tree/hierarchy.hpp"
#include "odds/tree/wide_tree.hpp"
#include "tree/saved_facts.hpp"
#include "tree/saved_file.hpp"
#include "tree/saved_file_writer.hpp"
#include "tree/tree_defect.hpp"

namespace odds::tree {

/// The arrays of a tree; its single numbers are left to the caller.
inline void add_tree(SavedFileWriter& writer, const WideTree& tree) {
  const WideTree::Parts& parts = tree.parts();
  writer.add(Section::wide_nodes, parts.nodes.span());
  if (!parts.leaves.empty()) writer.add(Section::wide_leaves, parts.leaves.span());
  writer.add(Section::statistics, parts.statistics.span());
  writer.add(Section::statistics_at, parts.statistics_at.span());
}

template <volume::BoundingVolume V>
void add_tree(SavedFileWriter& writer, const Hierarchy<V>& tree) {
  const auto& parts = tree.parts();
  writer.add(Section::nodes, parts.nodes.span());
  writer.add(Section::statistics, parts.statistics.span());
  if (parts.corners.empty()) return;
  writer.add(Section::corners, parts.corners.span());
  writer.add(Section::order, parts.order.span());
}

/// Reads one array after the other until one cannot be read.
class ArrayReader {
 public:
  explicit ArrayReader(const SavedFile& file) : file_(file) {}

  template <class T>
  void read(Section section, mesh::SharedArray<T>& into) {
    if (error_) return;
    auto records = file_.array<T>(section);
    if (records.ok()) {
      into = std::move(records).value();
    } else {
      error_ = records.error();
    }
  }
  [[nodiscard]] const std::optional<Error>& error() const noexcept { return error_; }

 private:
  const SavedFile& file_;
  std::optional<Error> error_;
};

/// What all kinds of trees take from the single numbers.
template <class Parts>
void take_facts(const SavedFacts& facts, Parts& parts) {
  parts.origin = Vec3(facts.origin[0], facts.origin[1], facts.origin[2]);
  parts.reach = facts.reach;
  parts.triangles = facts.triangles;
  parts.levels = static_cast<std::uint32_t>(facts.levels);
}

/// The tree if it has no defect, with or without polygons as the facts say.
[[nodiscard]] inline Result<WideTree> read_tree(const SavedFile& file, const SavedFacts& facts, const WideTree*) {
  WideTree::Parts parts;
  take_facts(facts, parts);
  ArrayReader reader(file);
  reader.read(Section::wide_nodes, parts.nodes);
  reader.read(Section::wide_leaves, parts.leaves);
  reader.read(Section::statistics, parts.statistics);
  reader.read(Section::statistics_at, parts.statistics_at);
  if (reader.error()) return *reader.error();
  if (parts.leaves.empty() != (facts.polygons == 0)) {
    return file.damaged(Section::facts, 0, "leaves are there, or not, against what the file says of itself");
  }
  if (const auto defect = find_defect(parts)) return file.damaged(defect->section, defect->record, defect->what);
  return WideTree(std::move(parts));
}

template <volume::BoundingVolume V>
[[nodiscard]] Result<Hierarchy<V>> read_tree(const SavedFile& file, const SavedFacts& facts, const Hierarchy<V>*) {
  typename Hierarchy<V>::Parts parts;
  take_facts(facts, parts);
  ArrayReader reader(file);
  reader.read(Section::nodes, parts.nodes);
  reader.read(Section::statistics, parts.statistics);
  reader.read(Section::corners, parts.corners);
  reader.read(Section::order, parts.order);
  if (reader.error()) return *reader.error();
  if (parts.corners.empty() != (facts.polygons == 0)) {
    return file.damaged(Section::facts, 0, "corners are there, or not, against what the file says of itself");
  }
  if (const auto defect = find_defect<V>(parts)) return file.damaged(defect->section, defect->record, defect->what);
  return Hierarchy<V>(std::move(parts));
}

}  // namespace odds::tree
