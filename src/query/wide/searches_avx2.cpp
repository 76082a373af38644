// Compiled with AVX2 where the compiler knows it; called only where the processor has it.
#include "query/wide/searches.hpp"
#if defined(__AVX2__)
#include "query/wide/searches_of.hpp"
#endif

namespace odds::query::wide {

const Searches* avx2_searches() noexcept {
#if defined(__AVX2__)
  static constexpr Searches searches = searches_of<lanes::Avx2>();
  return &searches;
#else
  return nullptr;
#endif
}

}  // namespace odds::query::wide
