// Every bounding volume that is offered, as values and as types: tests over them include a new one the moment it is
// listed.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <variant>

#include "odds/volume/kind.hpp"
#include "query/shape_data.hpp"

namespace odds::testing {

[[nodiscard]] constexpr std::array<volume::Kind, volume::kind_names.size()> all_kinds() noexcept {
  std::array<volume::Kind, volume::kind_names.size()> kinds{};
  for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i] = static_cast<volume::Kind>(i);
  return kinds;
}

/// For the names of parameterised tests.
[[nodiscard]] inline std::string name_of(volume::Kind kind) { return std::string(volume::name(kind)); }

namespace detail {

template <class Volumes>
struct VolumesOf;

template <class... V>
struct VolumesOf<query::Volumes<V...>> {
  using Types = ::testing::Types<V...>;
};

}  // namespace detail

/// Of the generic framework, in the order of volume::Kind.
using AllVolumes = detail::VolumesOf<query::GenericVolumes>::Types;

}  // namespace odds::testing
