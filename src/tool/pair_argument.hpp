// Two meshes of a command line made ready for queries.
#pragma once

#include <string>

#include "odds/math/error.hpp"
#include "odds/query/pair.hpp"
#include "tool/shape_argument.hpp"

namespace odds::tool {

struct PairArgument {
  std::string mesh_a;
  std::string mesh_b;
  double scale_a = 1.0;  ///< metres per unit of the file
  double scale_b = 1.0;
  ShapeWish shape;
  query::PairOptions options;
};

/// Reads and builds both, with progress, or loads what was saved; one shape for a mesh that is given twice.
Result<query::Pair> make_pair(const PairArgument& argument);

}  // namespace odds::tool
