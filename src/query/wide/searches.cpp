// The searches for every processor of the family, and the choice among all.
#include "query/wide/searches_of.hpp"

namespace odds::query::wide {

namespace {

template <class L>
const Searches* searches_on() noexcept {
  static constexpr Searches searches = searches_of<L>();
  return &searches;
}

const Searches* sse2_searches() noexcept {
#if defined(__SSE2__)
  return searches_on<lanes::Sse2>();
#else
  return nullptr;
#endif
}

const Searches* neon_searches() noexcept {
#if defined(__aarch64__)
  return searches_on<lanes::Neon>();
#else
  return nullptr;
#endif
}

const Searches* avx2_searches_here() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2") ? avx2_searches() : nullptr;
#else
  return nullptr;
#endif
}

// Not where the processor slows its clock for such registers: those that do lack a later part of the family, VBMI2.
const Searches* avx512_searches_here() noexcept {
#if defined(__x86_64__)
  const bool has = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vbmi2");
  return has ? avx512_searches() : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace

const Searches* searches_for(InstructionSet set) noexcept {
  switch (set) {
    case InstructionSet::avx512:
      return avx512_searches_here();
    case InstructionSet::avx2:
      return avx2_searches_here();
    case InstructionSet::sse2:
      return sse2_searches();
    case InstructionSet::neon:
      return neon_searches();
    case InstructionSet::portable:
      return searches_on<lanes::Portable>();
    case InstructionSet::best:
      break;
  }
  if (const Searches* searches = avx512_searches_here()) return searches;
  if (const Searches* searches = avx2_searches_here()) return searches;
  if (const Searches* searches = sse2_searches()) return searches;
  if (const Searches* searches = neon_searches()) return searches;
  return searches_on<lanes::Portable>();
}

}  // namespace odds::query::wide

namespace odds::query::patch {

const Kernels& best_kernels() noexcept { return wide::searches_for(InstructionSet::best)->patch; }

}  // namespace odds::query::patch
