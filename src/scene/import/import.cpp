// From a description to the text of a scene.
#include "odds/scene/import.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>

#include "odds/mesh/write.hpp"
#include "odds/scene/scene.hpp"
#include "scene/import/bodies.hpp"
#include "scene/import/readers.hpp"

namespace odds::scene {
namespace {

// A name that is harmless as the name of a file, and like no other.
std::string file_name(const std::string& name, std::set<std::string>& used) {
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
  if (safe.empty()) safe = "body";
  std::string unique = safe;
  for (int i = 2; !used.insert(unique).second; ++i) unique = fmt::format("{}_{}", safe, i);
  return unique;
}

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

// Comments must not end before their line does.
std::string comment(const std::string& text) {
  std::string line;
  for (const char c : text) line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
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
  std::set<std::string> used;
  for (const RigidBody& body : bodies) {
    const std::string name = file_name(body.name, used);
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
  for (const ImportedMesh& mesh : imported.meshes) {
    if (auto error = mesh::write(mesh.mesh, folder / mesh.file)) return error;
  }
  const std::filesystem::path scene = folder / "scene.toml";
  std::ofstream file(scene, std::ios::binary);
  file << imported.text;
  file.flush();
  if (file) return std::nullopt;
  return Error{scene.string(), "", "cannot be written", "check the folder, its permissions and the free space"};
}

}  // namespace odds::scene
