// Which effects a scene asks for, and whether they have something to work on.
#include "scene/effect_tables.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "odds/haptics/effect_registry.hpp"

namespace odds::scene {
namespace {

using haptics::Effect;
using haptics::Settings;
using haptics::SettingsReader;

// [effects.NAME] is one table, [[effects.NAME]] several.
std::vector<const Settings*> tables_of(SettingsReader& reader, std::string_view name) {
  const haptics::Setting* setting = reader.settings().find(name);
  if (setting != nullptr && std::holds_alternative<haptics::Value::List>(setting->value.data)) {
    return reader.tables(name);
  }
  const Settings* table = reader.table(name);
  return table == nullptr ? std::vector<const Settings*>{} : std::vector<const Settings*>{table};
}

struct Made {
  const AskedEffect* asked = nullptr;
  std::unique_ptr<Effect> effect;
};

std::optional<Error> check(const Scene& scene, const Made& made) {
  const auto error = [&](const std::string& what, const std::string& remedy) {
    return Error{scene.file, made.asked->place.text(), what, remedy};
  };
  const std::string rests_on(made.effect->rests_on());
  std::string words = made.asked->name;
  std::replace(words.begin(), words.end(), '_', ' ');
  if (!rests_on.empty() && scene.find_effect(rests_on) == nullptr) {
    return error(fmt::format("{} needs {}", words, rests_on),
                 fmt::format("add [effects.{}], or remove this table", rests_on));
  }
  const bool needs_points = (made.effect->needs() & (haptics::need_one_contact | haptics::need_patch)) != 0;
  if (needs_points && scene.query.max_contacts == 0) {
    return error(fmt::format("{} needs points of contact, and 'max_contacts' of [query] is 0", words),
                 "give 'max_contacts' from 1 to 8, or remove this table");
  }
  const bool held = scene.device.has_value();  // one that no body follows is refused elsewhere
  if ((made.effect->needs() & haptics::need_device) != 0 && !held) {
    return error(fmt::format("the {} has no device to pull towards", words),
                 "add a [device.NAME] and device = \"NAME\" in a [[body]], or remove this table");
  }
  const bool moving = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.dynamic; });
  if ((made.effect->needs() & haptics::need_motion) != 0 && !moving) {
    return error("this effect moves bodies, but no body is dynamic",
                 "give a [[body]] motion = \"dynamic\" and a mass, or remove this table");
  }
  const auto same = std::count_if(scene.effects.begin(), scene.effects.end(),
                                  [&](const AskedEffect& e) { return e.name == made.asked->name; });
  if (same > 1 && !made.effect->repeatable()) {
    return error(fmt::format("{} is asked for {} times", words, same), "keep one of the tables");
  }
  return std::nullopt;
}

}  // namespace

std::vector<haptics::BodyInfo> body_infos(const Scene& scene) {
  std::vector<haptics::BodyInfo> infos;
  for (const Body& body : scene.bodies) infos.push_back({body.name, body.dynamic});
  return infos;
}

std::optional<Error> read_effects(const Settings& settings, Scene& scene) {
  SettingsReader reader(settings);
  for (const haptics::EffectType& type : haptics::effect_types()) {
    for (const Settings* table : tables_of(reader, type.name)) {
      scene.effects.push_back({std::string(type.name), *table, table->place});
    }
  }
  if (auto error = reader.finish()) return error;
  const std::vector<haptics::BodyInfo> bodies = body_infos(scene);
  for (const AskedEffect& asked : scene.effects) {
    auto made = haptics::make_effect(asked.name, {&asked.settings, bodies, scene.loop.period_s()});
    if (!made) return made.error();
    if (auto error = check(scene, {&asked, std::move(made).value()})) return error;
  }
  const std::unique_ptr<haptics::EffectSet> together = scene.make_effects();
  auto error = together->check(scene.world_options(*together));
  if (error) error->file = scene.file;
  return error;
}

const AskedEffect* Scene::find_effect(std::string_view effect_name) const {
  const auto found =
      std::find_if(effects.begin(), effects.end(), [&](const AskedEffect& e) { return e.name == effect_name; });
  return found == effects.end() ? nullptr : &*found;
}

std::unique_ptr<haptics::EffectSet> Scene::make_effects() const {
  auto set = std::make_unique<haptics::EffectSet>();
  const std::vector<haptics::BodyInfo> infos = body_infos(*this);
  for (const AskedEffect& asked : effects) {
    auto made = haptics::make_effect(asked.name, {&asked.settings, infos, loop.period_s()});
    if (made) set->add(asked.name, asked.place, std::move(made).value());  // read_effects has made it once already
  }
  return set;
}

}  // namespace odds::scene
