// XML with places and strict numbers; the only place that sees the XML library.
#pragma once

#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "odds/haptics/settings.hpp"
#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"

namespace odds::scene {

/// An Error on its way out of the readers of descriptions, which end at the first; caught by import_description.
struct ImportFailure {
  Error error;
};

/// One description in memory. Functions throw ImportFailure with file, line and column.
class XmlReader {
 public:
  /// Refuses what is not XML, too large, or made for a preprocessor.
  explicit XmlReader(const std::filesystem::path& path);

  [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] haptics::Place place_of(pugi::xml_node node) const;
  [[noreturn]] void fail(pugi::xml_node node, const std::string& what, const std::string& remedy) const;

  /// An attribute that must be there and say something.
  [[nodiscard]] std::string text(pugi::xml_node node, const char* attribute) const;
  /// The attribute "name" behind the names of what it stands in, "" or "outer::inner::"; 256 bytes together.
  [[nodiscard]] std::string name(pugi::xml_node node, const std::string& scope = "") const;
  /// Refuses more than 256 bytes.
  void check_name(pugi::xml_node node, std::string_view full) const;
  /// The text of an element, without blanks around it.
  [[nodiscard]] static std::string text_of(pugi::xml_node node);
  /// Whether the text says true, in letters of any size, or 1. Refuses what is neither that nor false, 0 or blank.
  [[nodiscard]] bool flag(pugi::xml_node node, std::string_view text) const;
  /// Of four numbers; refuses what is no rotation.
  [[nodiscard]] Mat3 rotation_of_xyzw(pugi::xml_node node, const double* xyzw) const;
  /// The text of a child element that must be there, without blanks around it.
  [[nodiscard]] std::string child_text(pugi::xml_node node, const char* child) const;
  [[nodiscard]] pugi::xml_node child(pugi::xml_node node, const char* name) const;

  /// Exactly `count` finite numbers of a magnitude up to 1e12, separated by blanks.
  [[nodiscard]] std::vector<double> numbers(pugi::xml_node node, std::string_view text, std::size_t count,
                                            std::string_view what) const;
  [[nodiscard]] double positive(pugi::xml_node node, std::string_view text, std::string_view what) const;
  [[nodiscard]] Vec3 vector(pugi::xml_node node, std::string_view text, std::string_view what) const;
  /// The name that was probably meant; "" if none is near, and for absurdly long ones.
  [[nodiscard]] static std::string nearest(std::string_view name, std::vector<std::string_view> candidates);

  [[nodiscard]] Vec3 positive_vector(pugi::xml_node node, std::string_view text, std::string_view what) const;

 private:
  [[nodiscard]] double number(pugi::xml_node node, std::string_view word, std::string_view what) const;

  std::filesystem::path path_;
  std::string text_;
  std::vector<std::size_t> line_ends_;
  pugi::xml_document document_;
};

/// Turns about the fixed axes x, y, z, in this order: both formats' "roll pitch yaw".
[[nodiscard]] Mat3 rotation_of_rpy(const Vec3& rpy_rad);

}  // namespace odds::scene
