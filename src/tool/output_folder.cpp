#include "tool/output_folder.hpp"

#include <vector>

#include "mesh/output_file.hpp"

namespace odds::tool {

std::optional<Error> prepare_folder(const std::filesystem::path& folder, std::initializer_list<const char*> inside) {
  if (folder.empty()) return Error{"", "", "the name of the output folder is empty", "name a folder after --out"};
  std::vector<std::filesystem::path> folders{folder};
  for (const char* name : inside) folders.push_back(folder / name);
  for (const std::filesystem::path& each : folders) {
    std::error_code code;
    std::filesystem::create_directories(each, code);
    if (code) return Error{folder.string(), "", "cannot be made: " + code.message(), "give another --out"};
    const Result<mesh::OutputFile> trial = mesh::OutputFile::open(each / "writable");
    if (!trial) return Error{each.string(), "", trial.error().what, "check its permissions, or give another --out"};
  }
  return std::nullopt;
}

}  // namespace odds::tool
