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

/// Between A's face and what of B is deepest in it.
wide::KnownFaces::Layer layer_between(const PosedMeshes& meshes, const mesh::FlatFace& a, const mesh::FlatFace& b,
                                      double depth, double size) noexcept {
  const double offset_a = a.offset - a.normal.dot(meshes.origin_a()) - 0.5 * depth;
  const Vec3 in_b = meshes.pose().rotation.transpose() * a.normal;
  const double offset_b = offset_a - a.normal.dot(meshes.pose().translation);
  const auto single = [](double x) noexcept { return static_cast<float>(x); };
  return {{{single(a.normal.x()), single(a.normal.y()), single(a.normal.z())},
           {single(in_b.x()), single(in_b.y()), single(in_b.z())}},
          {single(offset_a), single(offset_b)},
          single(0.5 * depth + a.uneven + b.uneven + off_a_face * size)};
}

wide::KnownFaces known_faces(const PosedMeshes& meshes, const Pair::Implementation& pair) noexcept {
  wide::KnownFaces faces;
  pair.flush.see_faces([&](const mesh::FlatFace& a, const mesh::FlatFace& b, double depth) noexcept {
    faces.add(layer_between(meshes, a, b, depth, smaller_size(pair)));
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
  if (pair.nothing_beside_at &&
      math::motion_bound(*pair.nothing_beside_at, meshes.pose(), pair.b->mesh().size()) <= little) {
    return Beside::nothing;
  }
  pair.nothing_beside_at.reset();
  const Beside seen = look(meshes, request, known_faces(meshes, pair), pair, spending);
  if (seen == Beside::nothing) pair.nothing_beside_at = meshes.pose();
  return seen;
}

}  // namespace odds::query
