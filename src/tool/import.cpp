// odds import: a robot or world description becomes a scene.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "odds/scene/import.hpp"
#include "odds/scene/scene.hpp"
#include "tool/command.hpp"
#include "tool/one_line.hpp"
#include "tool/output_folder.hpp"

namespace odds::tool {
namespace {

struct ImportArguments {
  std::string description;
  std::string out = "odds_import";
  std::vector<std::string> packages;
  std::string motion = "described";
};

int import_scene(const ImportArguments& arguments) {
  scene::ImportOptions options;
  if (arguments.motion != "described") {
    options.motion = arguments.motion == "fixed" ? scene::ImportMotion::fixed : scene::ImportMotion::dynamic;
  }
  for (const std::string& text : arguments.packages) {
    const std::size_t at = text.find('=');
    if (at == 0 || at == std::string::npos || at + 1 == text.size()) {
      return fail({"", "", fmt::format("--package '{}' is not NAME=FOLDER", text), "give a name and its folder"});
    }
    options.packages[text.substr(0, at)] = text.substr(at + 1);
  }
  const Result<scene::ImportedScene> imported = scene::import_description(arguments.description, options);
  if (!imported) return fail(imported.error());
  const scene::ImportedScene& made = imported.value();
  if (const auto error = prepare_folder(arguments.out, {})) return fail(*error);
  if (const auto error = scene::write_imported(made, arguments.out)) return fail(*error);
  const std::filesystem::path file = std::filesystem::path(arguments.out) / "scene.toml";
  const Result<scene::Scene> scene = scene::read_scene(file);
  if (!scene) return fail(scene.error());
  std::size_t triangles = 0;
  for (const scene::ImportedMesh& mesh : made.meshes) triangles += mesh.mesh.triangles().size();
  fmt::print("{}: {} models, {} links, {} joints: {} bodies of {} triangles\n", on_one_line(arguments.description),
             made.models, made.links, made.joints, made.bodies, triangles);
  for (const std::string& sentence : made.assumptions) fmt::print("assumed: {}\n", on_one_line(sentence));
  fmt::print("scene: {}\n", on_one_line(file.string()));
  return exit_good;
}

}  // namespace

void add_import(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand("import", "Make a scene from a URDF or SDFormat description");
  command->add_option("description", arguments->description, "a URDF or SDFormat file")->required();
  command->add_option("--out", arguments->out, "folder for scene.toml and its meshes")->capture_default_str();
  command
      ->add_option("--package", arguments->packages,
                   "NAME=FOLDER: where package://NAME and model://NAME are; may be given several times")
      ->allow_extra_args(false);  // else the description after it would be taken for another
  command->add_option("--motion", arguments->motion, "whether the bodies move")
      ->check(CLI::IsMember({"described", "fixed", "dynamic"}))
      ->capture_default_str();
  command->callback([&action, arguments] { action = [arguments] { return import_scene(*arguments); }; });
}

}  // namespace odds::tool
