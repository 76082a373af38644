// `odds build MESH -o FILE`: a hierarchy saved, to be mapped in milliseconds wherever a mesh is asked for.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "mesh/output_file.hpp"
#include "odds/query/saved_shape.hpp"
#include "tool/command.hpp"
#include "tool/shape_argument.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct BuildOptions {
  std::string mesh;
  std::string out;
  double scale = 1.0;
  ShapeWish shape;
  bool polygon_free = false;
};

int run(const BuildOptions& options) {
  if (const auto error = mesh::refuse_overwriting(options.out, {options.mesh})) return fail(*error);
  const auto built = load_shape(options.mesh, options.scale, options.shape);
  if (!built.ok()) return fail(built.error());
  const auto shape = options.polygon_free ? built.value()->without_polygons() : built.value();
  if (const auto error = query::save_shape(*shape, options.out)) return fail(*error);
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(options.out, unknown);
  const query::ShapeSummary& summary = shape->summary();
  const std::string size =
      unknown ? ""  // a pipe has none
              : fmt::format(", {:.2f} MiB ({:.0f} bytes a triangle)", static_cast<double>(bytes) / 1048576.0,
                            static_cast<double>(bytes) / static_cast<double>(summary.triangles));
  fmt::print("{}: {}, {} triangles{}{}, built in {:.1f} ms\n", options.out, volume::name(shape->volume()),
             summary.triangles, shape->has_polygons() ? "" : " without their polygons", size, summary.build_ms);
  return exit_good;
}

}  // namespace

void add_build(CLI::App& app, Action& action) {
  const auto options = std::make_shared<BuildOptions>();
  CLI::App* command =
      app.add_subcommand("build", "Build a mesh's hierarchy and save it; commands take the file in place of the mesh");
  command->add_option("MESH", options->mesh, shape_argument_help())->required();
  command->add_option("-o,--out", options->out, "file for the hierarchy and its mesh")->required();
  command->add_option("--scale", options->scale, "metres per unit of the file, as 0.001 for millimetres")
      ->check(positive_and_finite());
  add_shape_options(*command, options->shape);
  command->add_flag("--polygon-free", options->polygon_free,
                    "drop the polygons: smaller; answers are probabilities then, never proved hits");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace odds::tool
