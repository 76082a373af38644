// `odds inspect MESH`: faults, sizes, hierarchy and node statistics; of a saved hierarchy, what it holds.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "mesh/output_file.hpp"
#include "odds/mesh/faults.hpp"
#include "odds/mesh/repair.hpp"
#include "odds/mesh/write.hpp"
#include "odds/query/shape.hpp"
#include "tool/command.hpp"
#include "tool/progress_line.hpp"
#include "tool/shape_argument.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct InspectOptions {
  std::string mesh;
  double scale = 1.0;
  ShapeWish shape;
  std::string repair_to;
  bool json = false;
};

/// Everything that is known about one mesh.
struct Inspection {
  std::shared_ptr<const query::Shape> shape;
  std::optional<mesh::Faults> faults;  ///< of a mesh that has its polygons
  std::string hint;
  bool saved = false;  ///< the shape came from a file of `odds build`

  [[nodiscard]] const mesh::TriangleMesh& mesh() const { return shape->mesh(); }
};

Result<Inspection> inspect(const InspectOptions& options) {
  auto shape = load_shape(options.mesh, options.scale, options.shape);
  if (!shape.ok()) return shape.error();
  Inspection found;
  found.shape = std::move(shape).value();
  found.saved = found.shape->summary().load_ms > 0.0;
  if (!found.shape->has_polygons()) return found;
  const ProgressLine progress("looking for faults");
  found.faults = mesh::find_faults(found.mesh());
  if (!found.saved) found.hint = mesh::units_hint(found.mesh());
  return found;
}

double a_triangle(std::size_t bytes, const query::ShapeSummary& summary) {
  return static_cast<double>(bytes) / static_cast<double>(summary.triangles);
}

double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / 1048576.0; }

std::string point(const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z()); }

template <class Item>
std::string examples(const mesh::Finding<Item>& finding) {
  std::string text;
  const std::size_t shown = std::min<std::size_t>(finding.examples.size(), 5);
  for (std::size_t i = 0; i < shown; ++i) {
    if constexpr (std::is_same_v<Item, mesh::Edge>) {
      text += fmt::format("{}{}-{}", i == 0 ? "" : ", ", finding.examples[i][0], finding.examples[i][1]);
    } else {
      text += fmt::format("{}{}", i == 0 ? "" : ", ", finding.examples[i]);
    }
  }
  return finding.count > shown ? text + ", ..." : text;
}

template <class Item>
void print_finding(const char* title, const mesh::Finding<Item>& finding) {
  if (finding.count == 0) {
    fmt::print("  {:<22}{:>10}\n", title, 0);
  } else {
    fmt::print("  {:<22}{:>10}   {}\n", title, finding.count, examples(finding));
  }
}

void print_faults(const mesh::Faults& faults) {
  const auto yes = [](bool is) { return is ? "yes" : "no"; };
  fmt::print("closed          {}\n", yes(faults.closed));
  fmt::print("manifold        {}\n", yes(faults.manifold));
  fmt::print("orientable      {} (winding consistent: {})\n", yes(faults.orientable), yes(faults.consistent()));
  fmt::print("components      {}\n", faults.components);
  fmt::print("area            {:.6g} m2\n", faults.area);
  if (faults.volume) {
    fmt::print("volume          {:.6g} m3{}\n", *faults.volume, *faults.volume < 0.0 ? " (faces point inwards)" : "");
  }
  fmt::print("faults{:>28}   (first indices)\n", "count");
  print_finding("degenerate triangles", faults.degenerate);
  print_finding("duplicate triangles", faults.duplicate);
  print_finding("slivers", faults.sliver);
  print_finding("boundary edges", faults.boundary);
  print_finding("non-manifold edges", faults.non_manifold);
  print_finding("inconsistent edges", faults.inconsistent);
  print_finding("non-manifold vertices", faults.non_manifold_vertex);
  print_finding("duplicate vertices", faults.duplicate_vertex);
  print_finding("unused vertices", faults.unused_vertex);
}

void print_memory(const query::Shape& shape) {
  const query::ShapeSummary& summary = shape.summary();
  fmt::print("  memory        {:.2f} MiB, {:.0f} bytes a triangle", mebibytes(summary.bytes),
             a_triangle(summary.bytes, summary));
  if (!shape.has_polygons()) {
    fmt::print(", polygons dropped\n");
    return;
  }
  fmt::print("; {:.0f} with the mesh, {:.0f} without polygons\n",
             a_triangle(summary.bytes + summary.mesh_bytes, summary), a_triangle(summary.polygon_free_bytes, summary));
}

void print_hierarchy(const Inspection& found) {
  const query::ShapeSummary& summary = found.shape->summary();
  fmt::print("hierarchy       {}, leaves of at most {} triangles, tau {:g}\n", volume::name(found.shape->volume()),
             found.shape->options().leaf_triangles, found.shape->options().tau);
  fmt::print("  nodes         {} ({} leaves, {:.2f} triangles each), {} levels\n", summary.nodes, summary.leaves,
             summary.mean_leaf_triangles, summary.depth);
  fmt::print("  well filled   {:.1f} of 512 cells, mean of inner nodes\n", summary.mean_well_filled_cells);
  print_memory(*found.shape);
  fmt::print("  build         {:.1f} ms", summary.build_ms);
  if (found.saved) fmt::print(" when it was made; checked and loaded in {:.1f} ms", summary.load_ms);
  fmt::print("\n");
}

void print_text(const Inspection& found) {
  const mesh::TriangleMesh& mesh = found.mesh();
  fmt::print("mesh            {}\n", mesh.name());
  fmt::print("triangles       {}\n", found.shape->summary().triangles);
  if (found.faults) fmt::print("vertices        {}\n", mesh.vertices().size());
  fmt::print("bounds          {} .. {} m\n", point(mesh.lower()), point(mesh.upper()));
  fmt::print("size            {:.6g} m (diagonal)\n", mesh.size());
  if (!found.hint.empty()) fmt::print("hint            {}\n", found.hint);
  if (found.faults) print_faults(*found.faults);
  print_hierarchy(found);
}

template <class Item>
nlohmann::ordered_json finding_json(const mesh::Finding<Item>& finding) {
  return {{"count", finding.count}, {"examples", finding.examples}};
}

nlohmann::ordered_json hierarchy_json(const Inspection& found) {
  const query::ShapeSummary& summary = found.shape->summary();
  return {{"bounding_volume", std::string(volume::name(found.shape->volume()))},
          {"tau", found.shape->options().tau},
          {"polygons", found.shape->has_polygons()},
          {"nodes", summary.nodes},
          {"leaves", summary.leaves},
          {"levels", summary.depth},
          {"mean_leaf_triangles", summary.mean_leaf_triangles},
          {"mean_well_filled_cells", summary.mean_well_filled_cells},
          {"bytes", summary.bytes},
          {"bytes_per_triangle", a_triangle(summary.bytes, summary)},
          {"bytes_per_triangle_with_mesh", a_triangle(summary.bytes + summary.mesh_bytes, summary)},
          {"bytes_per_triangle_polygon_free", a_triangle(summary.polygon_free_bytes, summary)},
          {"build_ms", summary.build_ms},
          {"load_ms", summary.load_ms}};
}

void add_faults(nlohmann::ordered_json& json, const mesh::Faults& faults) {
  json["closed"] = faults.closed;
  json["manifold"] = faults.manifold;
  json["orientable"] = faults.orientable;
  json["consistent_winding"] = faults.consistent();
  json["components"] = faults.components;
  json["area_m2"] = faults.area;
  json["volume_m3"] = faults.volume ? nlohmann::ordered_json(*faults.volume) : nlohmann::ordered_json(nullptr);
  json["faults"] = {{"degenerate_triangles", finding_json(faults.degenerate)},
                    {"duplicate_triangles", finding_json(faults.duplicate)},
                    {"slivers", finding_json(faults.sliver)},
                    {"boundary_edges", finding_json(faults.boundary)},
                    {"non_manifold_edges", finding_json(faults.non_manifold)},
                    {"inconsistent_edges", finding_json(faults.inconsistent)},
                    {"non_manifold_vertices", finding_json(faults.non_manifold_vertex)},
                    {"duplicate_vertices", finding_json(faults.duplicate_vertex)},
                    {"unused_vertices", finding_json(faults.unused_vertex)}};
}

nlohmann::ordered_json to_json(const Inspection& found) {
  const mesh::TriangleMesh& mesh = found.mesh();
  const auto array = [](const Vec3& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  nlohmann::ordered_json json = {{"mesh", mesh.name()},
                                 {"triangles", found.shape->summary().triangles},
                                 {"vertices", nullptr},
                                 {"lower_m", array(mesh.lower())},
                                 {"upper_m", array(mesh.upper())},
                                 {"size_m", mesh.size()},
                                 {"hint", found.hint}};
  if (found.faults) {
    json["vertices"] = mesh.vertices().size();
    add_faults(json, *found.faults);
  }
  json["hierarchy"] = hierarchy_json(found);
  return json;
}

/// Writes the repaired copy.
Result<mesh::RepairLog> repair(const Inspection& found, const InspectOptions& options) {
  if (auto error = refuse_polygon_free(*found.shape, options.mesh)) return *std::move(error);
  Result<mesh::Repaired> repaired = mesh::repair(found.mesh());
  if (!repaired.ok()) return repaired.error();
  if (auto error = mesh::write(repaired.value().mesh, options.repair_to)) return *std::move(error);
  return repaired.value().log;
}

int run(const InspectOptions& options) {
  if (const auto error = mesh::refuse_overwriting(options.repair_to, {options.mesh})) return fail(*error);
  const Result<Inspection> found = inspect(options);
  if (!found.ok()) return fail(found.error());
  std::optional<mesh::RepairLog> log;
  if (!options.repair_to.empty()) {
    Result<mesh::RepairLog> repaired = repair(found.value(), options);
    if (!repaired.ok()) return fail(repaired.error());
    log = std::move(repaired).value();
  }
  if (options.json) {
    nlohmann::ordered_json json = to_json(found.value());
    if (log) json["repair"] = {{"written_to", options.repair_to}, {"done", log->lines()}};
    // Names of files need not be UTF-8; what is not is replaced rather than thrown at the user.
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return exit_good;
  }
  print_text(found.value());
  if (log) {
    fmt::print("repaired        {} (the figures above are of the mesh as given)\n", options.repair_to);
    for (const std::string& line : log->lines()) fmt::print("  {}\n", line);
  }
  return exit_good;
}

}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  const auto options = std::make_shared<InspectOptions>();
  CLI::App* command =
      app.add_subcommand("inspect", "Show a mesh's faults and sizes, its hierarchy and node statistics");
  command->add_option("MESH", options->mesh, shape_argument_help())->required();
  command->add_option("--scale", options->scale, "metres per unit of the file, as 0.001 for millimetres")
      ->check(positive_and_finite());
  add_shape_options(*command, options->shape);
  command->add_option("--repair", options->repair_to, "write a repaired copy (.obj, .stl, .ply) and say what was done");
  command->add_flag("--json", options->json, "machine-readable output");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace odds::tool
