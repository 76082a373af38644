#include "odds/query/saved_shape.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <system_error>
#include <utility>

#include "mesh/output_file.hpp"
#include "query/shape/box_mesh.hpp"
#include "query/shape/count_bytes.hpp"
#include "query/shape_data.hpp"
#include "tree/saved_tree.hpp"

namespace odds::query {
namespace {

using tree::SavedFacts;
using tree::SavedFile;
using tree::Section;

std::array<double, 3> plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

SavedFacts facts_of(const Shape& shape) {
  const ShapeSummary& summary = shape.summary();
  SavedFacts facts;
  std::visit(
      [&facts](const auto& tree) {
        facts.origin = plain(tree.origin());
        facts.reach = tree.reach();
        facts.levels = tree.levels();
      },
      shape.data().tree);
  facts.lower = plain(shape.mesh().lower());
  facts.upper = plain(shape.mesh().upper());
  facts.tau = shape.options().tau;
  facts.mean_well_filled_cells = summary.mean_well_filled_cells;
  facts.build_ms = summary.build_ms;
  facts.volume = static_cast<std::uint64_t>(shape.volume());
  facts.leaf_triangles = shape.options().leaf_triangles;
  facts.triangles = summary.triangles;
  facts.leaves = summary.leaves;
  facts.solid = shape.is_solid() ? 1 : 0;
  facts.polygons = shape.has_polygons() ? 1 : 0;
  return facts;
}

/// What is out of range among the single numbers; null: nothing. The mesh and the tree look at what they are given.
const char* fault_in(const SavedFacts& facts) {
  if (facts.volume >= volume::kind_names.size()) return "the number of its bounding volume is unknown";
  if (facts.triangles == 0 || facts.triangles > mesh::TriangleMesh::largest_count) return "it counts no triangles";
  if (facts.leaves == 0 || facts.leaves > facts.triangles) return "it counts more leaves than triangles, or none";
  if (facts.levels == 0 || facts.levels > tree::deepest_level + 1) return "it has too many levels, or none";
  if (facts.leaf_triangles == 0 || facts.leaf_triangles > 16) return "the size of its leaves is out of range";
  if (!(facts.tau > 0.0 && facts.tau <= 1.0)) return "its tau is out of range";
  constexpr double farthest = 4.0 * mesh::TriangleMesh::largest_coordinate;
  if (!(facts.reach >= 0.0 && facts.reach <= farthest)) return "its size is out of range";
  for (const double x : facts.origin) {
    if (std::abs(x) > farthest) return "its origin is out of range";
  }
  return nullptr;
}

/// Where the file holds what is wrong with the mesh in it: errors of meshes number a vertex or a triangle.
Error fault_of_mesh(const SavedFile& file, const Error& error) {
  const auto number_after = [&](std::string_view word) {
    std::size_t number = 0;
    const std::string_view place = error.place;
    if (place.starts_with(word)) std::from_chars(place.data() + word.size(), place.data() + place.size(), number);
    return number;
  };
  const std::string what = "its mesh: " + error.place + (error.place.empty() ? "" : ": ") + error.what;
  if (!file.has(Section::vertices)) return file.damaged(Section::facts, 0, what);
  if (error.place.starts_with("triangle ")) return file.damaged(Section::triangles, number_after("triangle "), what);
  if (error.place.starts_with("vertex ")) return file.damaged(Section::vertices, number_after("vertex "), what);
  return file.damaged(Section::facts, 0, what);
}

Result<mesh::TriangleMesh> read_mesh(const SavedFile& file, const SavedFacts& facts) {
  auto text = file.array<char>(Section::name);
  if (!text.ok()) return text.error();
  std::string name(text.value().data(), text.value().size());
  if (facts.polygons == 0) {
    auto box = box_mesh(vector(facts.lower), vector(facts.upper), std::move(name));
    return box.ok() ? std::move(box) : fault_of_mesh(file, box.error());
  }
  auto vertices = file.array<Vec3>(Section::vertices);
  if (!vertices.ok()) return vertices.error();
  auto triangles = file.array<mesh::Triangle>(Section::triangles);
  if (!triangles.ok()) return triangles.error();
  auto mesh = mesh::TriangleMesh::adopt(std::move(vertices).value(), std::move(triangles).value(), std::move(name),
                                        vector(facts.lower), vector(facts.upper));
  return mesh.ok() ? std::move(mesh) : fault_of_mesh(file, mesh.error());
}

Result<std::shared_ptr<const mesh::TriangleMesh>> shared_mesh(const SavedFile& file, const SavedFacts& facts) {
  auto mesh = read_mesh(file, facts);
  if (!mesh.ok()) return mesh.error();
  if (facts.polygons != 0 && mesh.value().triangles().size() != facts.triangles) {
    return file.damaged(Section::facts, 0, "mesh and hierarchy differ in the number of triangles");
  }
  return std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
}

/// Calls read_tree for the type that stands at `kind` in the list.
template <std::size_t... I>
Result<AnyTree> read_any_tree(const SavedFile& file, const SavedFacts& facts, std::index_sequence<I...>) {
  Result<AnyTree> read = AnyTree();
  const auto try_kind = [&]<std::size_t kind>(std::integral_constant<std::size_t, kind>) {
    if (facts.volume != kind) return;
    using Tree = std::variant_alternative_t<kind, AnyTree>;
    auto tree = tree::read_tree(file, facts, static_cast<const Tree*>(nullptr));
    read = tree.ok() ? Result<AnyTree>(AnyTree(std::in_place_index<kind>, std::move(tree).value())) : tree.error();
  };
  (try_kind(std::integral_constant<std::size_t, I>()), ...);
  return read;
}

ShapeSummary summary_of(const SavedFacts& facts, const AnyTree& tree, const mesh::TriangleMesh& mesh) {
  ShapeSummary summary;
  count_bytes(tree, mesh, summary);
  summary.triangles = facts.triangles;
  summary.leaves = facts.leaves;
  summary.mean_leaf_triangles = static_cast<double>(facts.triangles) / static_cast<double>(facts.leaves);
  summary.mean_well_filled_cells = facts.mean_well_filled_cells;
  summary.build_ms = facts.build_ms;
  return summary;
}

Result<std::shared_ptr<const Shape>> shape_in(tree::KeptBytes bytes, const std::string& name,
                                              std::chrono::steady_clock::time_point start) {
  const auto file = SavedFile::open(std::move(bytes), name);
  if (!file.ok()) return file.error();
  const auto records = file.value().array<SavedFacts>(Section::facts);
  if (!records.ok()) return records.error();
  if (records.value().size() != 1) return file.value().damaged(Section::facts, 0, "its single numbers are not there");
  const SavedFacts facts = records.value()[0];
  if (const char* fault = fault_in(facts)) return file.value().damaged(Section::facts, 0, fault);
  auto mesh = shared_mesh(file.value(), facts);
  if (!mesh.ok()) return mesh.error();
  auto tree = read_any_tree(file.value(), facts, std::make_index_sequence<std::variant_size_v<AnyTree>>());
  if (!tree.ok()) return tree.error();

  auto data = std::make_unique<Shape::Data>();
  data->mesh = std::move(mesh).value();
  data->tree = std::move(tree).value();
  data->options = {static_cast<volume::Kind>(facts.volume), static_cast<std::uint32_t>(facts.leaf_triangles),
                   facts.tau};
  data->summary = summary_of(facts, data->tree, *data->mesh);
  data->solid = facts.solid != 0;
  data->polygons = facts.polygons != 0;
  data->summary.load_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return Shape::of(std::move(data));
}

}  // namespace

void write_shape(const Shape& shape, std::ostream& out) {
  const SavedFacts facts = facts_of(shape);
  tree::SavedFileWriter writer;
  writer.add(Section::facts, std::span(&facts, 1));
  writer.add(Section::name, std::span<const char>(shape.mesh().name()));
  if (shape.has_polygons()) {
    writer.add(Section::vertices, shape.mesh().vertices());
    writer.add(Section::triangles, shape.mesh().triangles());
  }
  std::visit([&writer](const auto& tree) { tree::add_tree(writer, tree); }, shape.data().tree);
  writer.write(out);
}

std::optional<Error> save_shape(const Shape& shape, const std::filesystem::path& path) {
  Result<mesh::OutputFile> file = mesh::OutputFile::open(path);
  if (!file.ok()) return file.error();
  mesh::OutputStream out(file.value());
  write_shape(shape, out);
  return file.value().commit();
}

Result<std::shared_ptr<const Shape>> load_shape(const std::filesystem::path& path) {
  const auto start = std::chrono::steady_clock::now();
  auto bytes = tree::map_file(path, {sizeof(tree::SavedHeader), &tree::may_be_whole});
  if (!bytes.ok()) return bytes.error();
  return shape_in(std::move(bytes).value(), path.string(), start);
}

Result<std::shared_ptr<const Shape>> load_shape(std::span<const std::byte> bytes, const std::string& name) {
  const auto start = std::chrono::steady_clock::now();
  return shape_in(tree::copy_bytes(bytes), name, start);
}

bool is_saved_shape(const std::filesystem::path& path) noexcept {
  std::error_code unknown;  // a pipe would have to be waited for, and gives its bytes only once
  if (!std::filesystem::is_regular_file(path, unknown)) return false;
  std::array<std::byte, tree::SavedHeader::right_magic.size()> begin{};
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  const std::size_t count = std::fread(begin.data(), 1, begin.size(), file);
  std::fclose(file);
  return tree::begins_like_saved_file(std::span(begin).first(count));
}

}  // namespace odds::query
