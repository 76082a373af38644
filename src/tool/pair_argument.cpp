#include "tool/pair_argument.hpp"

namespace odds::tool {

Result<query::Pair> make_pair(const PairArgument& argument) {
  const auto a = load_shape(argument.mesh_a, argument.scale_a, argument.shape);
  if (!a.ok()) return a.error();
  const bool twins = argument.mesh_a == argument.mesh_b && argument.scale_a == argument.scale_b;
  const auto b = twins ? a : load_shape(argument.mesh_b, argument.scale_b, argument.shape);
  if (!b.ok()) return b.error();
  return query::Pair::make(a.value(), b.value(), argument.options);
}

}  // namespace odds::tool
