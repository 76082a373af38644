// Two pairs at once where registers hold sixteen lanes: what the kernels of box_kernel.hpp compare then.
#pragma once

#include "query/wide/box_kernel.hpp"

namespace odds::query::wide {

/// As OnePair<L>, with the first pair in the lower half of the lanes.
template <class L>
struct TwoPairs;

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
template <>
struct TwoPairs<lanes::Avx512> {
  using Lanes = lanes::Sixteen;
  using F = Lanes::Float;

  /// The turns into the trees of both nodes.
  struct alignas(64) Turned {
    float column[3][3][16];
    float abs_column[3][3][16];
    float translation[3][16];

    ODDS_LANES_INLINE void fill(const Turn& lower, const Turn& upper) noexcept {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          _mm512_store_ps(column[j][i], Lanes::all(lower.column[j][i], upper.column[j][i]).v);
          _mm512_store_ps(abs_column[j][i], Lanes::all(lower.abs_column[j][i], upper.abs_column[j][i]).v);
        }
        _mm512_store_ps(translation[i], Lanes::all(lower.t[i], upper.t[i]).v);
      }
    }
    [[nodiscard]] ODDS_LANES_INLINE F of(int j, int i) const noexcept { return Lanes::load(column[j][i]); }
    [[nodiscard]] ODDS_LANES_INLINE F abs_of(int j, int i) const noexcept { return Lanes::load(abs_column[j][i]); }
    [[nodiscard]] ODDS_LANES_INLINE F t(int i) const noexcept { return Lanes::load(translation[i]); }
  };
  struct Boxes {
    LaneNumbers lower;
    LaneNumbers upper;

    [[nodiscard]] ODDS_LANES_INLINE F center(int i) const noexcept {
      return Lanes::all(lower.center(i), upper.center(i));
    }
    [[nodiscard]] ODDS_LANES_INLINE F half(int i) const noexcept { return Lanes::all(lower.half(i), upper.half(i)); }
    [[nodiscard]] ODDS_LANES_INLINE F normal(int i) const noexcept {
      return Lanes::all(lower.normal(i), upper.normal(i));
    }
    [[nodiscard]] ODDS_LANES_INLINE F offset() const noexcept { return Lanes::all(lower.offset(), upper.offset()); }
    [[nodiscard]] ODDS_LANES_INLINE F thickness() const noexcept {
      return Lanes::all(lower.thickness(), upper.thickness());
    }
  };
  struct Nodes {
    const WideNode* of[2];

    [[nodiscard]] ODDS_LANES_INLINE F center(int i) const noexcept {
      return Lanes::load(of[0]->center[i], of[1]->center[i]);
    }
    [[nodiscard]] ODDS_LANES_INLINE F half(int i) const noexcept { return Lanes::load(of[0]->half[i], of[1]->half[i]); }
    [[nodiscard]] ODDS_LANES_INLINE F normal(int i) const noexcept {
      return Lanes::load(of[0]->normal[i], of[1]->normal[i]);
    }
    [[nodiscard]] ODDS_LANES_INLINE F offset() const noexcept { return Lanes::load(of[0]->offset, of[1]->offset); }
    [[nodiscard]] ODDS_LANES_INLINE F thickness() const noexcept {
      return Lanes::load(of[0]->thickness, of[1]->thickness);
    }
  };
};
#endif

}  // namespace odds::query::wide
