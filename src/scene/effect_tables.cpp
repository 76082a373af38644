// One function per effect: its keys, their units and ranges.
#include "scene/effect_tables.hpp"

namespace odds::scene {
namespace {

using haptics::Range;
using haptics::SettingsReader;

void read(SettingsReader& reader, Contact& contact) {
  reader.number("stiffness_n_per_m", Range::positive(), contact.stiffness_n_per_m);
  reader.number("damping_ns_per_m", Range::not_negative(), contact.damping_ns_per_m);
  reader.number("max_correcting_velocity_m_per_s", Range::positive(), contact.max_correcting_velocity_m_per_s);
}

void read(SettingsReader& reader, Friction& friction) {
  reader.require("mu");
  reader.number("mu", {0.0, 100.0, true}, friction.mu);
}

void read(SettingsReader& reader, Gravity& gravity) { reader.vector("g_m_per_s2", gravity.g_m_per_s2); }

void read(SettingsReader& reader, haptics::VirtualCoupling& coupling) {
  reader.number("k_t_n_per_m", Range::positive(), coupling.k_t_n_per_m);
  reader.number("b_t_ns_per_m", Range::not_negative(), coupling.b_t_ns_per_m);
  reader.number("k_r_nm_per_rad", Range::positive(), coupling.k_r_nm_per_rad);
  reader.number("b_r_nms_per_rad", Range::not_negative(), coupling.b_r_nms_per_rad);
  reader.number("max_force_n", Range::positive(), coupling.max_force_n);
  reader.number("max_torque_nm", Range::positive(), coupling.max_torque_nm);
}

void read(SettingsReader& reader, ode::Damping& damping) {
  reader.number("linear_per_s", Range::not_negative(), damping.linear_per_s);
  reader.number("angular_per_s", Range::not_negative(), damping.angular_per_s);
}

template <class Parameters>
std::optional<Error> read_effect(SettingsReader& effects, std::string_view name,
                                 std::optional<Effect<Parameters>>& effect) {
  const haptics::Settings* table = effects.table(name);
  if (table == nullptr) return std::nullopt;
  Effect<Parameters> asked;
  asked.place = table->place;
  SettingsReader reader(*table);
  read(reader, static_cast<Parameters&>(asked));
  effect = asked;
  return reader.finish();
}

}  // namespace

std::optional<Error> read_effects(const haptics::Settings& settings, Effects& effects) {
  SettingsReader reader(settings);
  if (auto error = read_effect(reader, "contact", effects.contact)) return error;
  if (auto error = read_effect(reader, "friction", effects.friction)) return error;
  if (auto error = read_effect(reader, "gravity", effects.gravity)) return error;
  if (auto error = read_effect(reader, "virtual_coupling", effects.virtual_coupling)) return error;
  if (auto error = read_effect(reader, "damping", effects.damping)) return error;
  return reader.finish();
}

}  // namespace odds::scene
