#include "calibration/nodes.hpp"

#include <type_traits>
#include <variant>

#include "calibration/named_shape.hpp"
#include "query/posed_meshes.hpp"
#include "query/shape_data.hpp"
#include "support/node_sample.hpp"

namespace odds::calibration {

Result<std::vector<JudgedPair>> judged_pairs(const Meeting& meeting, volume::Kind volume, std::uint64_t poses_per_band,
                                             std::uint64_t seed) {
  constexpr std::size_t kept_of_a_pose = 48;
  SharedShape wide[2];
  SharedShape shapes[2];
  for (int side = 0; side < 2; ++side) {
    const std::string& name = side == 0 ? meeting.a : meeting.b;
    auto exact = named_shape(name, volume::Kind::wide);
    if (!exact.ok()) return exact.error();
    auto built = named_shape(name, volume);
    if (!built.ok()) return built.error();
    wide[side] = exact.value();
    shapes[side] = built.value();
  }
  auto maker = report::PoseMaker::make(wide[0], wide[1], meeting.procedure, seed);
  if (!maker.ok()) return maker.error();
  const std::uint64_t bands = report::pose_bands(meeting.procedure).size();
  std::vector<JudgedPair> judged;
  query::HitList hits{8};
  for (std::uint64_t i = 0; i < poses_per_band * bands; ++i) {
    const auto made = maker.value().pose(i);
    if (!made.ok()) return made.error();
    std::visit(
        [&](const auto& tree_a) {
          using Tree = std::remove_cvref_t<decltype(tree_a)>;
          if constexpr (!std::is_same_v<Tree, tree::WideTree>) {
            const Tree& tree_b = *std::get_if<Tree>(&shapes[1]->data().tree);
            const query::PosedMeshes meshes(shapes[0]->mesh(), shapes[1]->mesh(), tree_a.origin(), tree_b.origin(),
                                            made.value().pose());
            const query::Request request;
            const query::Encounter met(tree_a, tree_b, meshes.pose(), request);
            for (const query::NodePair& pair : testing::sample_nodes(met, kept_of_a_pose, i)) {
              judged.push_back(
                  {met.numbers(pair.a, pair.b), testing::meet_below(met, pair, hits), made.value().offset, i / bands});
            }
          }
        },
        shapes[0]->data().tree);
  }
  return judged;
}

}  // namespace odds::calibration
