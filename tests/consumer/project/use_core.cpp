// Uses the core: two made shapes, one query with a proof.
#include <odds/mesh/made/by_name.hpp>
#include <odds/query/pair.hpp>

#include <cstdio>

int main() {
  auto box = odds::mesh::made::make_shape("made:box");
  if (!box) return 1;
  auto mesh = std::make_shared<const odds::mesh::TriangleMesh>(std::move(box).value());
  auto shape = odds::query::Shape::build(mesh);
  if (!shape) return 2;
  auto pair = odds::query::Pair::make(shape.value(), shape.value());
  if (!pair) return 3;
  odds::math::Pose pose_b_in_a;
  pose_b_in_a.translation = {0.25 * mesh->size(), 0.0, 0.0};
  const odds::query::Answer near = pair.value().run(pose_b_in_a, {});
  pose_b_in_a.translation *= 100.0;
  const odds::query::Answer far = pair.value().run(pose_b_in_a, {});
  std::printf("core: P(near) = %.3f, P(far) = %.3f\n", near.probability, far.probability);
  return near.probability == 1.0 && far.probability == 0.0 ? 0 : 4;
}
