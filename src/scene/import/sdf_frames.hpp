// Where frames stand that are told relative to each other, in any order.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "odds/math/pose.hpp"
#include "scene/import/xml_reader.hpp"

namespace odds::scene {

/// Frames of a world by their full names, "model::link". The world itself is "".
class SdfFrames {
 public:
  explicit SdfFrames(const XmlReader& xml) : xml_(xml) {}

  /// A name in use is refused.
  void add(const std::string& name, const std::string& base, const math::Pose& in_base, pugi::xml_node said_by);
  /// Refuses names that lead nowhere or back to themselves; `asked_by` is where `name` itself stands.
  [[nodiscard]] math::Pose in_world(const std::string& name, pugi::xml_node asked_by);

 private:
  struct Frame {
    std::string base;
    math::Pose in_base;
    pugi::xml_node said_by;
    std::optional<math::Pose> in_world;  // once somebody has asked
    bool asked = false;
  };
  [[noreturn]] void refuse_unknown(const std::string& name, pugi::xml_node asked_by) const;
  const XmlReader& xml_;
  std::map<std::string, Frame, std::less<>> frames_;
};

}  // namespace odds::scene
