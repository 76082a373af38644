// The list of device types.
#include "odds/haptics/device_registry.hpp"

#include <fmt/core.h>

#include <map>

#include "odds/haptics/human_arm_device.hpp"
#include "odds/haptics/null_device.hpp"
#include "odds/haptics/replay_device.hpp"
#include "odds/haptics/scripted_device.hpp"

namespace odds::haptics {
namespace {

using Registry = std::map<std::string, DeviceFactory, std::less<>>;

Registry& registry() {
  static Registry factories = {{"human_arm", &HumanArmDevice::make},
                               {"null", &NullDevice::make},
                               {"replay", &ReplayDevice::make},
                               {"scripted", &ScriptedDevice::make}};
  return factories;
}

}  // namespace

void register_device(std::string name, DeviceFactory factory) {
  registry().insert_or_assign(std::move(name), std::move(factory));
}

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const auto& [name, factory] : registry()) names.push_back(name);
  return names;
}

Result<std::unique_ptr<Device>> make_device(std::string_view name, const DeviceRequest& request) {
  const auto found = registry().find(name);
  if (found != registry().end()) return found->second(request);
  const std::vector<std::string> known = device_names();
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string near = nearest_name(name, views);
  const Setting* type = request.settings->find("type");
  const Place place = type != nullptr ? type->value.place : request.settings->place;
  return Error{request.settings->file, place.text(), fmt::format("there is no device of the type '{}'", name),
               near.empty() ? "give " + list_names(views)
                            : fmt::format("did you mean '{}'? (valid: {})", near, list_names(views))};
}

}  // namespace odds::haptics
