// Compiled with AVX2 where the compiler knows it; called only where the processor has it.
#include "ablation/without_slabs.hpp"

#if defined(__AVX2__)
#include "query/wide/searches_of.hpp"

namespace odds::ablation {
struct BoxesOnly : query::lanes::Avx2 {};
}  // namespace odds::ablation

namespace odds::query::lanes {
template <>
struct DoublesOf<ablation::BoxesOnly> : DoublesOf<Avx2> {};
}  // namespace odds::query::lanes

namespace odds::query::wide {
template <>
inline constexpr bool looks_at_slabs<ablation::BoxesOnly> = false;
}  // namespace odds::query::wide
#endif

namespace odds::ablation {

const query::wide::Searches* searches_with_slabs() noexcept {
  return query::wide::searches_for(query::InstructionSet::avx2);
}

const query::wide::Searches* searches_without_slabs() noexcept {
#if defined(__AVX2__)
  static constexpr query::wide::Searches searches = query::wide::searches_of<BoxesOnly>();
  return searches_with_slabs() != nullptr ? &searches : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace odds::ablation
