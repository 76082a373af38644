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

constexpr std::size_t header_bytes = 12;

std::size_t chunk_bytes(std::size_t content) { return 8 + (content + 3) / 4 * 4; }

// Precondition: the chunk's size fits 32 bits.
void append_chunk(std::string& file, const char* type, std::string_view content, char padding) {
  const std::size_t end = file.size() + chunk_bytes(content.size());
  append(file, static_cast<std::uint32_t>(chunk_bytes(content.size()) - 8));
  file.append(type, 4);
  file += content;
  file.resize(end, padding);
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

Result<std::string> GlbBuilder::file(std::uint64_t most_bytes) {
  json["buffers"] = {{{"byteLength", bytes_.size()}}};
  const std::string text = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  const std::size_t size = header_bytes + chunk_bytes(text.size()) + chunk_bytes(bytes_.size());
  if (size > most_bytes) {
    return Error{"", "",
                 "would have " + std::to_string(size) + " bytes, and a GLB file at most " + std::to_string(most_bytes),
                 "show a shorter run, or coarser meshes"};
  }
  std::string file = "glTF";
  file.reserve(size);
  append(file, 2);
  append(file, static_cast<std::uint32_t>(size));
  append_chunk(file, "JSON", text, ' ');
  append_chunk(file, std::string("BIN\0", 4).c_str(), bytes_, '\0');
  return file;
}

}  // namespace odds::report
