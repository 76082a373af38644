// The list of effects.
#include "odds/haptics/effect_registry.hpp"

#include <algorithm>
#include <array>
#include <atomic>

#include "haptics/effects/list.hpp"

namespace odds::haptics {
namespace {

#define ODDS_ENTRY(name) EffectType{#name, &effects::make_##name},
constexpr std::array types = {ODDS_EFFECTS(ODDS_ENTRY)};
#undef ODDS_ENTRY

std::array<std::atomic<std::uint64_t>, types.size()> made{};

}  // namespace

std::span<const EffectType> effect_types() noexcept { return types; }

std::size_t effect_index(std::string_view name) noexcept {
  const auto found =
      std::find_if(types.begin(), types.end(), [&](const EffectType& type) { return type.name == name; });
  return static_cast<std::size_t>(found - types.begin());
}

Result<std::unique_ptr<Effect>> make_effect(std::string_view name, const EffectRequest& request) {
  const std::size_t index = effect_index(name);
  made[index].fetch_add(1, std::memory_order_relaxed);
  return types[index].make(request);
}

std::uint64_t effects_made(std::string_view name) noexcept {
  const std::size_t index = effect_index(name);
  return index < types.size() ? made[index].load(std::memory_order_relaxed) : 0;
}

std::string needs_text(std::uint32_t needs) {
  static constexpr std::array<std::pair<std::uint32_t, const char*>, 9> words = {{{need_verdict, "verdict"},
                                                                                  {need_one_contact, "one contact"},
                                                                                  {need_patch, "contact patch"},
                                                                                  {need_velocity, "contact velocity"},
                                                                                  {need_angular_rows, "angular rows"},
                                                                                  {need_history, "history"},
                                                                                  {need_motion, "moving bodies"},
                                                                                  {need_device, "device"},
                                                                                  {need_contact_work, "contact work"}}};
  std::string text;
  for (const auto& [bit, word] : words) {
    if ((needs & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(word);
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace odds::haptics
