#include "tool/pair_argument.hpp"

#include <memory>

#include "tool/mesh_argument.hpp"
#include "tool/progress_line.hpp"

namespace odds::tool {
namespace {

Result<std::shared_ptr<const query::Shape>> build(const std::string& argument, double scale,
                                                  const query::ShapeOptions& options) {
  Result<mesh::TriangleMesh> mesh = load_mesh(argument, scale);
  if (!mesh.ok()) return mesh.error();
  ProgressLine progress("building " + argument);
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), options,
                             [&](double share) { progress.show(share); });
}

}  // namespace

Result<query::Pair> make_pair(const PairArgument& argument) {
  const auto a = build(argument.mesh_a, argument.scale_a, argument.shape);
  if (!a.ok()) return a.error();
  const bool twins = argument.mesh_a == argument.mesh_b && argument.scale_a == argument.scale_b;
  const auto b = twins ? a : build(argument.mesh_b, argument.scale_b, argument.shape);
  if (!b.ok()) return b.error();
  return query::Pair::make(a.value(), b.value());
}

}  // namespace odds::tool
