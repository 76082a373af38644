// One parameter of a made shape: its name on the command line, its range and what it means.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace odds::mesh::made {

/// A shape lists its parameters as fields; checking, reading from text and the help text all come from that one list.
template <class Shape>
struct Field {
  std::string_view name;
  std::variant<double Shape::*, std::uint32_t Shape::*, std::uint64_t Shape::*> member;
  double least;     ///< smallest value allowed
  double greatest;  ///< greatest value allowed
  std::string_view meaning;
};

}  // namespace odds::mesh::made
