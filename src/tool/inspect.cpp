// `odds inspect MESH`: faults, sizes, hierarchy and node statistics.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "odds/mesh/faults.hpp"
#include "odds/mesh/repair.hpp"
#include "odds/mesh/write.hpp"
#include "odds/query/shape.hpp"
#include "tool/command.hpp"
#include "tool/mesh_argument.hpp"
#include "tool/output_file.hpp"
#include "tool/progress_line.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct InspectOptions {
  std::string mesh;
  double scale = 1.0;
  query::ShapeOptions shape;
  std::string repair_to;
  bool json = false;
};

/// Everything that is known about one mesh.
struct Inspection {
  std::shared_ptr<const mesh::TriangleMesh> mesh;
  mesh::Faults faults;
  std::string hint;
  std::shared_ptr<const query::Shape> shape;
};

Result<Inspection> inspect(mesh::TriangleMesh&& given, const query::ShapeOptions& options) {
  Inspection found;
  found.mesh = std::make_shared<const mesh::TriangleMesh>(std::move(given));
  {
    const ProgressLine progress("looking for faults");
    found.faults = mesh::find_faults(*found.mesh);
  }
  found.hint = mesh::units_hint(*found.mesh);
  ProgressLine progress("building the hierarchy");
  auto shape = query::Shape::build(found.mesh, options, [&](double share) { progress.show(share); });
  if (!shape.ok()) return shape.error();
  found.shape = shape.value();
  return found;
}

double bytes_per_triangle(const query::ShapeSummary& summary) {
  return static_cast<double>(summary.bytes) / static_cast<double>(summary.triangles);
}

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

void print_faults(const Inspection& found) {
  const mesh::Faults& faults = found.faults;
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

void print_text(const Inspection& found) {
  const mesh::TriangleMesh& mesh = *found.mesh;
  const query::ShapeSummary& summary = found.shape->summary();
  fmt::print("mesh            {}\n", mesh.name());
  fmt::print("triangles       {}\n", mesh.triangles().size());
  fmt::print("vertices        {}\n", mesh.vertices().size());
  fmt::print("bounds          {} .. {} m\n", point(mesh.lower()), point(mesh.upper()));
  fmt::print("size            {:.6g} m (diagonal)\n", mesh.size());
  if (!found.hint.empty()) fmt::print("hint            {}\n", found.hint);
  print_faults(found);
  fmt::print("hierarchy       {}, leaves of at most {} triangles, tau {:g}\n", volume::name(found.shape->volume()),
             found.shape->options().leaf_triangles, found.shape->options().tau);
  fmt::print("  nodes         {} ({} leaves, {:.2f} triangles each), {} levels\n", summary.nodes, summary.leaves,
             summary.mean_leaf_triangles, summary.depth);
  fmt::print("  well filled   {:.1f} of 512 cells, mean of inner nodes\n", summary.mean_well_filled_cells);
  fmt::print("  memory        {:.2f} MiB, {:.0f} bytes a triangle\n", static_cast<double>(summary.bytes) / 1048576.0,
             bytes_per_triangle(summary));
  fmt::print("  build         {:.1f} ms\n", summary.build_ms);
}

template <class Item>
nlohmann::ordered_json finding_json(const mesh::Finding<Item>& finding) {
  return {{"count", finding.count}, {"examples", finding.examples}};
}

nlohmann::ordered_json to_json(const Inspection& found) {
  const mesh::TriangleMesh& mesh = *found.mesh;
  const mesh::Faults& faults = found.faults;
  const query::ShapeSummary& summary = found.shape->summary();
  const auto array = [](const Vec3& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  nlohmann::ordered_json json = {{"mesh", mesh.name()},
                                 {"triangles", mesh.triangles().size()},
                                 {"vertices", mesh.vertices().size()},
                                 {"lower_m", array(mesh.lower())},
                                 {"upper_m", array(mesh.upper())},
                                 {"size_m", mesh.size()},
                                 {"hint", found.hint},
                                 {"closed", faults.closed},
                                 {"manifold", faults.manifold},
                                 {"orientable", faults.orientable},
                                 {"consistent_winding", faults.consistent()},
                                 {"components", faults.components},
                                 {"area_m2", faults.area}};
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
  json["hierarchy"] = {{"bounding_volume", std::string(volume::name(found.shape->volume()))},
                       {"tau", found.shape->options().tau},
                       {"nodes", summary.nodes},
                       {"leaves", summary.leaves},
                       {"levels", summary.depth},
                       {"mean_leaf_triangles", summary.mean_leaf_triangles},
                       {"mean_well_filled_cells", summary.mean_well_filled_cells},
                       {"bytes", summary.bytes},
                       {"bytes_per_triangle", bytes_per_triangle(summary)},
                       {"build_ms", summary.build_ms}};
  return json;
}

int run(const InspectOptions& options) {
  if (const auto error = refuse_overwriting(options.repair_to, {options.mesh})) return fail(*error);
  Result<mesh::TriangleMesh> mesh = load_mesh(options.mesh, options.scale);
  if (!mesh.ok()) return fail(mesh.error());
  std::optional<mesh::RepairLog> log;
  if (!options.repair_to.empty()) {
    Result<mesh::Repaired> repaired = mesh::repair(mesh.value());
    if (!repaired.ok()) return fail(repaired.error());
    if (const auto error = mesh::write(repaired.value().mesh, options.repair_to)) return fail(*error);
    log = repaired.value().log;
  }
  const Result<Inspection> found = inspect(std::move(mesh).value(), options.shape);
  if (!found.ok()) return fail(found.error());
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
  command->add_option("MESH", options->mesh, mesh_argument_help())->required();
  command->add_option("--scale", options->scale, "metres per unit of the file, as 0.001 for millimetres")
      ->check(positive_and_finite());
  add_shape_options(*command, options->shape);
  command->add_option("--repair", options->repair_to, "write a repaired copy (.obj, .stl, .ply) and say what was done");
  command->add_flag("--json", options->json, "machine-readable output");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace odds::tool
