// A guard against a compiler that forgets to round.
#pragma once

/// For functions that narrow doubles to float, widen them again, and rely on the difference, as fits of bounding volumes
/// do: GCC 12 from -O2 on leaves one of two such doubles side by side as it was (its vectorizer of straight-line code),
/// and a volume then encloses a little less than it says. Test: WideTreeOf.EnclosesEveryCornerInBoxAndSlabExactly.
#if defined(__GNUC__) && !defined(__clang__)
#define ODDS_KEEPS_ROUNDING __attribute__((optimize("no-tree-slp-vectorize")))
#else
#define ODDS_KEEPS_ROUNDING
#endif
