// The memory that contacts are made in, and the steps that share it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "odds/query/contact_patch.hpp"
#include "query/patch/components.hpp"
#include "query/patch/concave_corner.hpp"
#include "query/patch/normal.hpp"
#include "query/patch/overlap.hpp"
#include "query/patch/rim.hpp"
#include "query/patch/select.hpp"
#include "query/patch/watch.hpp"
#include "query/patch/witnesses.hpp"

namespace odds::query {
namespace patch {

inline constexpr std::size_t witnesses_per_pair = 6;
// Only coplanar triangles give more than one, and of a face full of those a sample is as good.
inline constexpr std::size_t pieces_per_pair = 3;
inline constexpr std::size_t least_pairs = 16;   ///< looked at however late it is
inline constexpr std::size_t hasty_pieces = 48;  ///< of the rim, that a patch made hastily is made from

/// How thoroughly a patch is made: by the clock, or, when that has run out, from some pieces of rim.
struct Effort {
  std::size_t sample;  ///< pairs that candidate normals are compared on
  bool ends_only;      ///< of all pairs only those at the ends of the patch are asked for witnesses
};
inline constexpr Effort thorough{24, false};
inline constexpr Effort hasty{12, true};

/// A finished patch.
struct Patch {
  Vec3 normal = Vec3::UnitZ();
  Vec3 lower = Vec3::Zero();  ///< box of the rim
  Vec3 upper = Vec3::Zero();
  Vec3 centre = Vec3::Zero();  ///< of the surface that the rim spans
  double low = 0.0;            ///< of the rim, and of what its contacts reach through, along `normal`
  double high = 0.0;
  double depth = 0.0;
  double length = 0.0;  ///< of the rim
  patch::Chosen chosen;
  std::size_t component = 0;  ///< of the rim
  bool in_corner = false;     ///< one of several of its component, each of a face of a concave corner
  bool dropped = false;
};

}  // namespace patch

/// One builder's.
struct PatchBuilder::Scratch {
  explicit Scratch(std::size_t hit_capacity)
      : pairs(hit_capacity),
        pieces(patch::pieces_per_pair * hit_capacity + patch::most_pieces_of_a_pair),
        by_patch(pieces.size()),
        witnesses(patch::witnesses_per_pair * std::min(hit_capacity, patch::Telling::most) + 64),
        components(pieces.size(), hit_capacity),
        telling(pieces.size()),
        corner_pieces(pieces.size()) {}

  /// Those that span the patch, its centre, its summits.
  using Measured = std::array<patch::Witness, most_contacts + 3>;
  using Indices = std::span<const std::uint32_t>;

  void place_pairs(const PatchInput& input, patch::Watch& watch) noexcept;
  void make_rim(const PatchInput& input, std::size_t most_pairs, patch::Watch& watch) noexcept;
  void cut_pairs(const PatchInput& input, std::size_t count, bool silent_too, patch::Watch& watch) noexcept;
  void sort_by_patch(std::size_t count, patch::Watch& watch) noexcept;
  [[nodiscard]] Indices pieces_of(std::size_t patch) const noexcept {
    return {by_patch.data() + first_of_patch[patch], first_of_patch[patch + 1] - first_of_patch[patch]};
  }
  bool make_patches(const PatchInput& input, patch::Watch& watch) noexcept;
  void straighten(const PatchInput& input, std::span<const patch::RimSums> sums, patch::Watch& watch) noexcept;
  void make_hasty_contacts(const PatchInput& input, const Deadline& last) noexcept;
  patch::Patch make_patch(const PatchInput& input, const patch::RimSums& sums, Indices indices,
                          const patch::Effort& effort, patch::Watch& watch, patch::ExitRanges exits = {}) noexcept;
  patch::Patch shorter_way_out(const patch::Patch& made, const Vec3& known, const patch::PatchView& view,
                               const patch::Effort& effort, patch::Watch& watch) noexcept;
  void reach_in(const patch::Patch& run_in, const patch::PatchView& view, patch::Patch& made,
                patch::Watch& watch) noexcept;
  void part_in_corner(const PatchInput& input, const patch::RimSums& sums, std::span<std::uint32_t> indices,
                      std::size_t others, patch::Watch& watch) noexcept;
  /// Of a patch that is found to be deeper than `most_depth`, no more than a depth above it is told.
  patch::Patch patch_along(const Vec3& normal, const PatchInput& input, const patch::RimSums& sums, Indices indices,
                           const patch::Effort& effort, patch::Watch& watch, patch::ExitRanges exits = {},
                           double most_depth = std::numeric_limits<double>::infinity()) noexcept;
  void find_witnesses(Indices indices, const patch::Frame& frame, patch::Watch& watch) noexcept;
  void add_witnesses(std::span<const patch::PlacedPair* const> asked, const patch::Frame& frame) noexcept;
  std::size_t probe(const PatchInput& input, const patch::RimSums& sums, const Vec3& centre, double reach,
                    const patch::Frame& frame, const patch::Chosen& spread, patch::ExitRanges exits, double most_depth,
                    Measured& measured, patch::Watch& watch) noexcept;
  void drop_crumbs() noexcept;
  void drop_opposed(const Vec3* previous, patch::Watch& watch) noexcept;
  void write(const PatchInput& input, patch::Watch& watch) noexcept;
  void write_pieces(const Vec3& normal, const patch::RimSums& sums, Indices indices) noexcept;

  const patch::Kernels* kernels = nullptr;  ///< of the contacts that are being made
  std::vector<patch::PlacedPair> pairs;
  std::vector<patch::RimPiece> pieces;
  std::vector<std::uint32_t> by_patch;
  std::array<std::uint32_t, patch::Components::most + 1> first_of_patch{};
  std::vector<patch::Witness> witnesses;
  patch::Components components;
  patch::Telling telling;
  std::vector<patch::CornerPiece> corner_pieces;
  patch::Fan fan;
  std::array<patch::Patch, patch::Components::most> patches;
  std::array<Contact, most_contacts> contacts;
  patch::Rim rim;
  std::size_t pair_count = 0;
  std::size_t piece_count = 0;
  std::size_t witness_count = 0;
  std::size_t patch_count = 0;
  std::size_t contact_count = 0;
  std::size_t most_wanted = 0;
  bool finished = true;
};

}  // namespace odds::query
