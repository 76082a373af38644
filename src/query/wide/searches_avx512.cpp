// Compiled with AVX-512 where the compiler knows it; called only where the processor has it.
#include "query/wide/searches.hpp"
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "query/wide/searches_of.hpp"
#endif

namespace odds::query::wide {

const Searches* avx512_searches() noexcept {
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
  static constexpr Searches searches = searches_of<lanes::Avx512>();
  return &searches;
#else
  return nullptr;
#endif
}

}  // namespace odds::query::wide
