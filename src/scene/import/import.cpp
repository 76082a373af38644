// From a description to the text of a scene.
#include "odds/scene/import.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "mesh/output_file.hpp"
#include "odds/mesh/write.hpp"
#include "odds/scene/scene.hpp"
#include "scene/import/bodies.hpp"
#include "scene/import/readers.hpp"

namespace odds::scene {
namespace {

// Names that are harmless as names of files, and each like no other.
class FileNames {
 public:
  std::string next(const std::string& name) {
    const std::string safe = harmless(name);
    int& number = numbers_.try_emplace(safe, 1).first->second;
    std::string unique = number == 1 ? safe : fmt::format("{}_{}", safe, number);
    while (!used_.insert(unique).second) unique = fmt::format("{}_{}", safe, ++number);
    return unique;
  }

 private:
  static std::string harmless(const std::string& name) {
    constexpr std::size_t longest = 80;
    std::string safe;
    for (const char c : name) {
      const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
      if (good) {
        safe += c;
      } else if (!safe.empty() && safe.back() != '_') {
        safe += '_';
      }
      if (safe.size() >= longest) break;
    }
    return safe.empty() ? "body" : safe;
  }

  std::set<std::string> used_;
  std::map<std::string, int> numbers_;  // the last one given, for each harmless name
};

std::string toml_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      quoted += fmt::format("\\u{:04x}", byte);
    } else {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted + "\"";
}

// Bytes of the UTF-8 character that `text` begins with; 0: it begins with none (Unicode 15, table 3-7).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xc2 && lead <= 0xdf ? 2U : lead >= 0xe0 && lead <= 0xef ? 3U : 4U;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  const unsigned char least = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
  const unsigned char most = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
  if (byte(1) < least || byte(1) > most) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
  }
  return length;
}

// Comments must not end before their line does, and TOML is UTF-8, which names in descriptions and of files need not
// be.
std::string comment(const std::string& text) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(std::string_view(text).substr(at));
    const auto byte = static_cast<unsigned char>(text[at]);
    if (length == 0) {
      line += '?';
    } else if (byte < 0x20 || byte == 0x7f) {
      line += ' ';
    } else {
      line += text.substr(at, length);
    }
    at += std::max<std::size_t>(length, 1);
  }
  return "# " + line + "\n";
}

std::string vector_text(std::initializer_list<double> numbers) {
  std::string text;
  for (const double x : numbers) text += (text.empty() ? "" : ", ") + fmt::format("{}", x + 0.0);
  return "[" + text + "]";
}

std::string body_text(const RigidBody& body, const std::string& name) {
  std::string text = fmt::format(
      "\n[[mesh]]\nname = {0}\nfile = \"meshes/{1}.obj\"\n\n[[body]]\nname = {0}\nmesh = {0}\n", toml_text(name), name);
  if (body.dynamic) {
    text += "motion = \"dynamic\"\n";
    text += body.mass_kg > 0.0 ? fmt::format("mass_kg = {}\n", body.mass_kg) : "density_kg_per_m3 = 1000\n";
  }
  const Vec3& p = body.in_world.translation;
  const Quat q = Quat(body.in_world.rotation).normalized();
  text += fmt::format("position_m = {}\n", vector_text({p.x(), p.y(), p.z()}));
  if (q.vec().norm() > 0.0) {
    text += fmt::format("orientation_wxyz = {}\n", vector_text({q.w(), q.x(), q.y(), q.z()}));
  }
  return text;
}

std::string effects_text(Description& description, bool any_dynamic) {
  std::string text = "\n[effects.contact]\n";
  if (any_dynamic) {
    text += "\n[effects.gravity]\n";
    if (description.gravity_m_per_s2) {
      const Vec3& g = *description.gravity_m_per_s2;
      text += fmt::format("g_m_per_s2 = {}\n", vector_text({g.x(), g.y(), g.z()}));
    } else {
      description.assumptions.emplace_back("gravity is 9.81 m/s^2 along -z");
    }
  }
  if (description.frictions.empty()) {
    description.assumptions.emplace_back("no friction is stated, so there is none: add [effects.friction]");
    return text;
  }
  const auto [least, greatest] = std::minmax_element(description.frictions.begin(), description.frictions.end());
  if (*least < *greatest) {
    description.assumptions.push_back(
        fmt::format("friction differs, from {} to {}: a scene has one coefficient, the smallest", *least, *greatest));
  }
  if (*least > 0.0) text += fmt::format("\n[effects.friction]\nmu = {}\n", std::min(*least, 100.0));
  if (*least > 100.0) description.assumptions.emplace_back("friction is bounded by 100");
  return text;
}

void note_left_out(Description& description) {
  std::string list;
  for (const auto& [name, count] : description.left_out) {
    list += fmt::format("{}{} <{}>", list.empty() ? "" : ", ", count, name);
  }
  if (!list.empty()) description.assumptions.push_back("left out: " + list);
}

ImportedScene make_scene(Description& description, const ImportOptions& options, Resources& resources) {
  ImportedScene scene;
  const std::vector<RigidBody> bodies = rigid_bodies(description, options, resources);
  const std::string file = resources.description().string();
  if (bodies.empty()) {
    throw ImportFailure{{file, "", "no link has collision geometry", "add a <collision> to a link"}};
  }
  std::string text;
  FileNames names;
  for (const RigidBody& body : bodies) {
    const std::string name = names.next(body.name);
    Result<mesh::TriangleMesh> mesh =
        mesh::TriangleMesh::make(body.triangles.vertices, body.triangles.triangles, body.name);
    if (!mesh) throw ImportFailure{{file, "", mesh.error().message(), "correct the sizes of this link's shapes"}};
    scene.meshes.push_back({"meshes/" + name + ".obj", std::move(mesh).value()});
    text += body_text(body, name);
  }
  const bool any_dynamic = std::any_of(bodies.begin(), bodies.end(), [](const RigidBody& b) { return b.dynamic; });
  text += effects_text(description, any_dynamic);
  note_left_out(description);
  std::string head = comment("Imported from " + resources.description().filename().string() + ". What was assumed:");
  for (const std::string& sentence : description.assumptions) head += comment("- " + sentence);
  scene.text = head + fmt::format("format = \"{}\"\n", format_name) + text;
  scene.assumptions = description.assumptions;
  scene.sources = resources.files();
  scene.sources.push_back(resources.description());
  scene.models = description.models.size();
  for (const Model& model : description.models) {
    scene.links += model.links.size();
    scene.joints += model.joints.size();
  }
  scene.bodies = bodies.size();
  return scene;
}

}  // namespace

Result<ImportedScene> import_description(const std::filesystem::path& path, const ImportOptions& options) {
  try {
    const XmlReader xml(path);
    const std::string_view root = xml.root().name();
    if (root != "robot" && root != "sdf") {
      xml.fail(xml.root(), fmt::format("<{}> is no description that is known", root.substr(0, 40)),
               "give a URDF (<robot>) or SDFormat (<sdf>) file");
    }
    Description description = root == "robot" ? read_urdf(xml) : read_sdf(xml);
    Resources resources(path, options);
    return make_scene(description, options, resources);
  } catch (const ImportFailure& failure) {
    return failure.error;
  }
}

std::optional<Error> write_imported(const ImportedScene& imported, const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder / "meshes", code);
  if (code) return Error{folder.string(), "", "cannot be made: " + code.message(), "give another folder"};
  const std::filesystem::path scene = folder / "scene.toml";
  const auto real = [&](const std::filesystem::path& path) {
    const std::filesystem::path found = std::filesystem::weakly_canonical(path, code);
    return code ? path : found;
  };
  std::set<std::filesystem::path> sources;
  for (const std::filesystem::path& source : imported.sources) sources.insert(real(source));
  const auto is_source = [&](const std::filesystem::path& path) { return sources.contains(real(path)); };
  const auto refuse = [](const std::filesystem::path& path) {
    return Error{path.string(), "", "is one of the files that were read, and would be replaced", "give another folder"};
  };
  if (is_source(scene)) return refuse(scene);
  for (const ImportedMesh& mesh : imported.meshes) {
    if (is_source(folder / mesh.file)) return refuse(folder / mesh.file);
  }
  for (const ImportedMesh& mesh : imported.meshes) {
    if (auto error = mesh::write(mesh.mesh, folder / mesh.file)) return error;
  }
  return mesh::write_file(scene, imported.text);
}

}  // namespace odds::scene
