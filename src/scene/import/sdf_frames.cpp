// Chains of frames, followed to the world.
#include "scene/import/sdf_frames.hpp"

#include <fmt/core.h>

namespace odds::scene {

void SdfFrames::add(const std::string& name, const std::string& base, const math::Pose& in_base,
                    pugi::xml_node said_by) {
  if (!frames_.emplace(name, Frame{base, in_base, said_by, std::nullopt, false}).second) {
    xml_.fail(said_by, fmt::format("a second frame named '{}'", name),
              "give each model, link, joint and frame its own name");
  }
}

void SdfFrames::refuse_unknown(const std::string& name, pugi::xml_node asked_by) const {
  std::vector<std::string_view> names;
  for (const auto& [known, frame] : frames_) names.push_back(known);
  const std::string near = XmlReader::nearest(name, names);
  xml_.fail(asked_by, fmt::format("there is no frame named '{}'", name),
            near.empty() ? "add it, or correct the name" : fmt::format("did you mean '{}'?", near));
}

// Every frame is looked at once, however many ask for it.
math::Pose SdfFrames::in_world(const std::string& name, pugi::xml_node asked_by) {
  std::vector<Frame*> chain;
  math::Pose pose;
  for (std::string at = name; !at.empty();) {
    const auto found = frames_.find(at);
    if (found == frames_.end()) refuse_unknown(at, chain.empty() ? asked_by : chain.back()->said_by);
    Frame& frame = found->second;
    if (frame.in_world) {
      pose = *frame.in_world;
      break;
    }
    if (frame.asked)
      xml_.fail(frame.said_by, fmt::format("the pose of '{}' leads back to itself", at), "correct a relative_to");
    frame.asked = true;
    chain.push_back(&frame);
    at = frame.base;
  }
  for (auto frame = chain.rbegin(); frame != chain.rend(); ++frame) {
    pose = pose * (*frame)->in_base;
    (*frame)->in_world = pose;
  }
  return pose;
}

}  // namespace odds::scene
