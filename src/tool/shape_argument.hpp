// A mesh or a saved hierarchy named on the command line, made ready for queries.
#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <string>

#include "odds/math/error.hpp"
#include "odds/query/shape.hpp"

namespace odds::tool {

/// What the user asked of a hierarchy; what is not given is the default of a mesh, or what a saved hierarchy has.
struct ShapeWish {
  std::optional<volume::Kind> volume;
  std::optional<double> tau;

  /// For a hierarchy that is to be built.
  [[nodiscard]] query::ShapeOptions options() const;
};

/// Adds --bv and --tau.
void add_shape_options(CLI::App& command, ShapeWish& wish);

/// Reads or makes the mesh and builds its hierarchy with progress, or loads a saved one, which must be as wished.
/// `scale` is metres per unit of a mesh file; a made shape and a saved hierarchy take 1 only.
Result<std::shared_ptr<const query::Shape>> load_shape(const std::string& argument, double scale,
                                                       const ShapeWish& wish);

/// An error where the command needs polygons and the shape has none.
std::optional<Error> refuse_polygon_free(const query::Shape& shape, const std::string& argument);

/// Help text for such an argument.
std::string shape_argument_help();

}  // namespace odds::tool
