// Checking a made shape's parameters against its fields, and its name with all that differs from the defaults. Private.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "mesh/made/number_text.hpp"
#include "odds/math/error.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/made/field.hpp"

namespace odds::mesh::made {

/// Bad parameters of a shape, as an error value.
template <class Shape>
Error refuse(const Shape&, std::string what, std::string remedy) {
  return {std::string(prefix) + std::string(Shape::name), "", std::move(what), std::move(remedy)};
}

/// The first parameter out of its range, if any. NaN is out of every range.
template <class Shape>
std::optional<Error> out_of_range(const Shape& shape) {
  for (const Field<Shape>& field : Shape::fields()) {
    const double value = std::visit([&](auto member) { return static_cast<double>(shape.*member); }, field.member);
    if (value >= field.least && value <= field.greatest) continue;
    return refuse(shape, std::string(field.name) + " = " + number_text(value) + " is out of range",
                  "give a value from " + number_text(field.least) + " to " + number_text(field.greatest));
  }
  return std::nullopt;
}

/// "made:torus:ring=0.2": make_shape gives the same mesh for it.
template <class Shape>
std::string title(const Shape& shape) {
  static constexpr Shape defaults{};
  std::string text = std::string(prefix) + std::string(Shape::name);
  char separator = ':';
  for (const Field<Shape>& field : Shape::fields()) {
    std::visit(
        [&](auto member) {
          if (shape.*member == defaults.*member) return;
          text += separator + std::string(field.name) + "=" + number_text(shape.*member);
          separator = ',';
        },
        field.member);
  }
  return text;
}

}  // namespace odds::mesh::made
