// What is made of a rim when the time for care has run out.
#include <algorithm>
#include <utility>

#include "query/patch/scratch.hpp"

namespace odds::query {

/// One patch of what there is of the rim. The pieces were made in an order that is spread over all hits, so that some
/// of them span, within the scatter of a sample, a share of the vector area that all of them do.
void PatchBuilder::Scratch::make_hasty_contacts(const PatchInput& input, const Deadline& last) noexcept {
  patch::Watch watch(last);
  PatchInput blind = input;
  blind.probe_a = blind.probe_b = {};
  blind.found_all = false;
  if (piece_count < patch::least_pairs) make_rim(blind, patch::least_pairs, watch);
  patch_count = 0;
  const std::size_t stride = (piece_count + patch::hasty_pieces - 1) / patch::hasty_pieces;
  std::size_t count = 0;
  patch::RimSums sums;
  for (std::size_t i = 0; i < piece_count && !(watch.late(count) && count >= patch::least_pairs); i += stride) {
    by_patch[count++] = static_cast<std::uint32_t>(i);
    sums.add(pieces[i], pairs[pieces[i].pair], rim.origin);
  }
  if (count == 0) return;
  sums.loose_ends = 1;
  const Indices indices{by_patch.data(), count};
  const patch::PatchView view{blind, *kernels, rim, sums, indices, patch::hasty.sample};
  const bool known = input.known_normal != nullptr;
  const patch::PatchNormal normal =
      known ? patch::PatchNormal{*input.known_normal, Vec3::Zero()} : patch_normal(view, watch);
  patch::Patch made = patch_along(normal.into_a, blind, sums, indices, patch::hasty, watch);
  if (!known) made = shorter_way_out(made, normal.shortest_way, view, patch::hasty, watch);
  if (watch.late()) return write_pieces(normal.into_a, sums, indices);
  patches[patch_count++] = made;
  write(input, watch);
}

/// Contacts at some pieces, as deep as the least overlap of their triangles, and no deeper than the rim is wide: of a
/// corner that has just come through the triangles reach on.
void PatchBuilder::Scratch::write_pieces(const Vec3& normal, const patch::RimSums& sums, Indices indices) noexcept {
  const std::size_t wanted = std::min<std::size_t>(most_wanted, indices.size());
  double depth = sums.diagonal();
  contact_count = 0;
  for (std::size_t i = 0; i < wanted; ++i) {
    const patch::RimPiece& piece = pieces[indices[i * indices.size() / wanted]];
    const patch::PlacedPair& placed = pairs[piece.pair];
    const auto [bottom_a, top_b] =
        std::pair(std::min({normal.dot(placed.a[0]), normal.dot(placed.a[1]), normal.dot(placed.a[2])}),
                  std::max({normal.dot(placed.b[0]), normal.dot(placed.b[1]), normal.dot(placed.b[2])}));
    depth = std::clamp(top_b - bottom_a, 0.0, depth);
    contacts[contact_count++] = {piece.middle(), normal, 0.0, placed.index.a, placed.index.b};
  }
  for (std::size_t i = 0; i < contact_count; ++i) contacts[i].depth = depth;
}

}  // namespace odds::query
