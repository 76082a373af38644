#include "query/contacts/look_beside.hpp"

#include <algorithm>
#include <array>

#include "odds/math/motion.hpp"
#include "odds/math/tolerances.hpp"

namespace odds::query {
namespace {

/// Of a budget, its beginning included: the rest is for contacts of what is found.
constexpr double share_of_a_look = 0.6;
/// Part of the smaller body's size by which what belongs to a face may stand off it: what is never guessed to be
/// deeper.
constexpr double off_a_face = tolerances::unmeasured_depth;

/// Between a face of one body and what of the other is deepest in it. The middle plane is the face's, moved into its
/// own body: `side` says whose it is.
wide::KnownFaces::Layer layer_along(std::size_t side, const PosedMeshes& meshes, const mesh::FlatFace& a,
                                    const mesh::FlatFace& b, double depth, double size) noexcept {
  const math::Pose& pose = meshes.pose();
  const Vec3 in_a = side == 0 ? a.normal : Vec3(pose.rotation * b.normal);
  const Vec3 in_b = side == 0 ? Vec3(pose.rotation.transpose() * a.normal) : b.normal;
  const double between = in_a.dot(pose.translation);
  const double own =
      side == 0 ? a.offset - a.normal.dot(meshes.origin_a()) : b.offset - b.normal.dot(meshes.origin_b());
  const double offset_a = own - 0.5 * depth + (side == 0 ? 0.0 : between);
  const auto single = [](double x) noexcept { return static_cast<float>(x); };
  return {
      {{single(in_a.x()), single(in_a.y()), single(in_a.z())}, {single(in_b.x()), single(in_b.y()), single(in_b.z())}},
      {single(offset_a), single(offset_a - between)},
      single(0.5 * depth + a.uneven + b.uneven + off_a_face * size)};
}

/// Of faces that lean a layer along one leaves the other: a floor of large triangles runs out of that of a crate which
/// stands on its edge, and the crate's walls, which cross the floor there, would touch beside it.
wide::KnownFaces known_faces(const PosedMeshes& meshes, const Pair::Implementation& pair) noexcept {
  const double size = smaller_size(pair);
  const double larger = std::max(pair.a->mesh().size(), pair.b->mesh().size());
  wide::KnownFaces faces;
  pair.flush.see_faces([&](const mesh::FlatFace& a, const mesh::FlatFace& b, double depth) noexcept {
    faces.add(layer_along(0, meshes, a, b, depth, size));
    const double tilt = (a.normal + meshes.pose().rotation * b.normal).norm();
    if (tilt * larger > off_a_face * size) faces.add(layer_along(1, meshes, a, b, depth, size));
  });
  return faces;
}

Beside look(const PosedMeshes& meshes, const Request& request, const wide::KnownFaces& faces,
            Pair::Implementation& pair, Spending& spending) noexcept {
  const auto* const a = std::get_if<tree::WideTree>(&pair.a->data().tree);
  const auto* const b = std::get_if<tree::WideTree>(&pair.b->data().tree);
  if (a == nullptr || b == nullptr) return Beside::unknown;
  const wide::Encounter encounter(*a, *b, meshes, request.estimator);
  SearchResult result;
  const std::size_t before = pair.hits.size();
  wide::Task task{encounter, request, static_cast<std::uint32_t>(before + most_contacts), nullptr, pair.hits,
                  spending,  result};
  spending.begin_start(share_of_a_look, share_of_a_look);
  pair.wide->beside_faces(task, faces);
  if (pair.hits.size() > before) {
    pair.answer.verdict = Verdict::hit;
    pair.answer.probability = 1.0;
    return Beside::something;
  }
  return result.ended == Progressed::spent ? Beside::unknown : Beside::nothing;
}

}  // namespace

Beside look_beside(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                   Spending& spending) noexcept {
  const double little = tolerances::unmeasured_depth * smaller_size(pair);
  const std::uint32_t lost = pair.flush.lost();
  if (pair.nothing_beside && pair.nothing_beside->lost_faces == lost &&
      math::approach_bound(pair.nothing_beside->pose, meshes.pose(), {pair.size_a, pair.size_b}) <= little) {
    return Beside::nothing;
  }
  pair.nothing_beside.reset();
  const Beside seen = look(meshes, request, known_faces(meshes, pair), pair, spending);
  if (seen == Beside::nothing) pair.nothing_beside = {meshes.pose(), lost};
  return seen;
}

}  // namespace odds::query
