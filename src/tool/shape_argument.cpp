#include "tool/shape_argument.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/saved_shape.hpp"
#include "tool/mesh_argument.hpp"
#include "tool/progress_line.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

using Loaded = Result<std::shared_ptr<const query::Shape>>;

/// An error if the saved shape is not what was wished.
std::optional<Error> contradiction(const query::Shape& shape, const std::string& file, double scale,
                                   const ShapeWish& wish) {
  if (scale != 1.0) {
    return Error{file, "", "a saved hierarchy is in metres, so a scale does not apply",
                 "give the scale to `odds build`"};
  }
  if (wish.volume && *wish.volume != shape.volume()) {
    return Error{
        file, "",
        fmt::format("its bounding volume is {}, not {}", volume::name(shape.volume()), volume::name(*wish.volume)),
        "leave --bv out, or make another file with `odds build`"};
  }
  if (wish.tau && *wish.tau != shape.options().tau) {
    return Error{file, "", fmt::format("it was built with tau {}, not {}", shape.options().tau, *wish.tau),
                 "leave --tau out, or make another file with `odds build`"};
  }
  return std::nullopt;
}

Loaded load_saved(const std::string& file, double scale, const ShapeWish& wish) {
  Loaded shape = query::load_shape(file);
  if (!shape.ok()) return shape;
  if (auto error = contradiction(*shape.value(), file, scale, wish)) return *std::move(error);
  return shape;
}

}  // namespace

query::ShapeOptions ShapeWish::options() const {
  query::ShapeOptions options;
  options.volume = volume.value_or(options.volume);
  options.tau = tau.value_or(options.tau);
  return options;
}

void add_shape_options(CLI::App& command, ShapeWish& wish) {
  std::map<std::string, volume::Kind> kinds;
  std::string names;
  for (const std::string_view word : volume::kind_words) {
    const volume::Kind kind = *volume::kind_from_name(word);
    kinds.emplace(word, kind);
    names += (names.empty() ? "" : ", ") + std::string(word);
    if (volume::name(kind) != word) names += " for " + std::string(volume::name(kind));
  }
  add_choice(command, "--bv", wish.volume, kinds, "bounding volume: " + names + " (default wide)");
  command.add_option("--tau", wish.tau, "share of the greatest area from which on a cell is well filled, (0, 1]")
      ->check(share_of_one());
}

Loaded load_shape(const std::string& argument, double scale, const ShapeWish& wish) {
  if (!argument.starts_with(mesh::made::prefix) && query::is_saved_shape(argument)) {
    return load_saved(argument, scale, wish);
  }
  Result<mesh::TriangleMesh> mesh = load_mesh(argument, scale);
  if (!mesh.ok()) return mesh.error();
  ProgressLine progress("building " + argument);
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), wish.options(),
                             [&](double share) { progress.show(share); });
}

std::optional<Error> refuse_polygon_free(const query::Shape& shape, const std::string& argument) {
  if (shape.has_polygons()) return std::nullopt;
  return Error{argument, "", "its polygons were dropped, and this needs them",
               "make the file with `odds build` without --polygon-free"};
}

std::string shape_argument_help() { return "a hierarchy saved by `odds build`, or a mesh: " + mesh_argument_help(); }

}  // namespace odds::tool
