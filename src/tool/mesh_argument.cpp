#include "tool/mesh_argument.hpp"

#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"

namespace odds::tool {

Result<mesh::TriangleMesh> load_mesh(const std::string& argument, double scale) {
  if (!argument.starts_with(mesh::made::prefix)) return mesh::read(argument, {.scale = scale});
  if (scale != 1.0) {
    return Error{argument, "", "a made shape is in metres, so a scale does not apply",
                 "give the shape's own sizes instead"};
  }
  return mesh::made::make_shape(argument);
}

std::string mesh_argument_help() {
  std::string text = "file (OBJ, STL, PLY, OFF, also .gz) or made:NAME[:key=value,...] with NAME one of";
  for (const std::string_view name : mesh::made::shape_names()) text.append(1, ' ').append(name);
  return text;
}

}  // namespace odds::tool
