// Writing GLB: little-endian, as x86 and ARM keep their numbers.
#include "report/glb_builder.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace odds::report {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr int float_type = 5126;
constexpr int unsigned_int_type = 5125;
constexpr int array_buffer = 34962;
constexpr int element_array_buffer = 34963;

void append(std::string& file, std::uint32_t number) {
  char bytes[4];
  std::memcpy(bytes, &number, sizeof bytes);
  file.append(bytes, sizeof bytes);
}

void append_chunk(std::string& file, const char* type, std::string content, char padding) {
  content.append((4 - content.size() % 4) % 4, padding);
  append(file, static_cast<std::uint32_t>(content.size()));
  file.append(type, 4);
  file += content;
}

}  // namespace

GlbBuilder::GlbBuilder() {
  json["asset"] = {{"version", "2.0"}, {"generator", "odds"}};
  json["scene"] = 0;
}

std::size_t GlbBuilder::view(std::string_view bytes, int target) {
  nlohmann::ordered_json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  bytes_ += bytes;
  json["bufferViews"].push_back(std::move(view));
  return json["bufferViews"].size() - 1;
}

std::size_t GlbBuilder::floats(std::span<const float> numbers, std::size_t components, bool of_vertices) {
  std::vector<float> least(components, std::numeric_limits<float>::max());
  std::vector<float> greatest(components, std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    least[i % components] = std::min(least[i % components], numbers[i]);
    greatest[i % components] = std::max(greatest[i % components], numbers[i]);
  }
  const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
  const std::size_t at = view(bytes, of_vertices ? array_buffer : 0);  // before: a new key moves the others
  json["accessors"].push_back({{"bufferView", at},
                               {"componentType", float_type},
                               {"count", numbers.size() / components},
                               {"type", components == 1   ? "SCALAR"
                                        : components == 3 ? "VEC3"
                                                          : "VEC4"},
                               {"min", least},
                               {"max", greatest}});
  return json["accessors"].size() - 1;
}

std::size_t GlbBuilder::indices(std::span<const std::uint32_t> numbers) {
  const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
  const std::size_t at = view(bytes, element_array_buffer);
  json["accessors"].push_back(
      {{"bufferView", at}, {"componentType", unsigned_int_type}, {"count", numbers.size()}, {"type", "SCALAR"}});
  return json["accessors"].size() - 1;
}

std::size_t GlbBuilder::node(nlohmann::ordered_json node) {
  json["nodes"].push_back(std::move(node));
  return json["nodes"].size() - 1;
}

void GlbBuilder::animate(std::size_t node, const char* path, std::size_t times, std::size_t values,
                         const char* interpolation) {
  nlohmann::ordered_json& animation = json["animations"][0];
  animation["name"] = "run";
  animation["samplers"].push_back({{"input", times}, {"interpolation", interpolation}, {"output", values}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

std::string GlbBuilder::file() {
  json["buffers"] = {{{"byteLength", bytes_.size()}}};
  std::string chunks;
  append_chunk(chunks, "JSON", json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), ' ');
  append_chunk(chunks, std::string("BIN\0", 4).c_str(), bytes_, '\0');
  std::string file = "glTF";
  append(file, 2);
  append(file, static_cast<std::uint32_t>(12 + chunks.size()));
  return file + chunks;
}

}  // namespace odds::report
