#include "calibration/unproved.hpp"

#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "calibration/named_shape.hpp"
#include "query/search/bottom_slice.hpp"
#include "query/shape_data.hpp"
#include "query/wide/searches.hpp"

namespace odds::calibration {
namespace {

/// Memory of a search, as a Pair has it.
struct Workspace {
  query::BucketQueue queue{4096};
  query::HitList hits{256};
  query::BottomSlice slice{16384};
  query::wide::KineticFront front{16384};
};

template <class Met>
std::optional<Unproved> left_at_end(const Met& met, const query::SearchResult& result, const query::Spending& spending,
                                    bool polygon_free) {
  if (result.ended != query::Progressed::spent && !result.is_judged()) return std::nullopt;
  if (result.shortlist.empty()) return std::nullopt;
  const query::NodePair& likeliest = result.shortlist.highest();
  const float probability = met.probability(likeliest.a, likeliest.b);
  Unproved left;
  left.judged = result.is_judged();
  left.remains = query::remains_of(met, result, spending.so_far(), probability, polygon_free);
  return left;
}

/// One search from the beginning. Nothing: it was proved.
template <class Tree>
std::optional<Unproved> search(const Tree& a, const Tree& b, const query::Shape& shape_a, const query::Shape& shape_b,
                               const math::Pose& pose, const query::Request& request, Workspace& memory) {
  const query::PosedMeshes meshes(shape_a.mesh(), shape_b.mesh(), a.origin(), b.origin(), pose);
  query::Spending spending(request.budget);
  query::SearchResult result;
  memory.hits.clear();
  if constexpr (std::is_same_v<Tree, tree::WideTree>) {
    const query::wide::Encounter met(a, b, meshes, request.estimator);
    if (met.far_apart()) return std::nullopt;
    const query::wide::Searches& searches = *query::wide::searches_for(query::InstructionSet::best);
    query::wide::Task task{met, request, 1, &memory.queue, memory.hits, spending, result};
    if (request.method == query::Method::time_critical) searches.time_critical(task);
    if (request.method == query::Method::exact) searches.exact(task);
    if (request.method == query::Method::incremental) {
      memory.front.reset();
      memory.front.move_to(meshes.pose(), {a.reach(), b.reach()});
      searches.incremental(task, memory.front);
    }
    return left_at_end(met, result, spending, request.polygon_free);
  } else {
    const query::Encounter met(a, b, meshes.pose(), request);
    if (met.far_apart() || !met.volumes_overlap(0, 0)) return std::nullopt;
    if (request.method == query::Method::time_critical) {
      result = query::TimeCriticalSearch(met, request, 1, memory.queue, memory.hits, spending).run({0, 0, 0.0F});
    } else if (request.method == query::Method::exact) {
      query::search_depth_first(met, {0, 0, 0.0F}, 1, memory.hits, spending, result);
    } else {
      memory.slice.reset();
      memory.slice.search(met, 1, memory.hits, spending, result);
    }
    return left_at_end(met, result, spending, request.polygon_free);
  }
}

std::optional<Unproved> search(const query::Shape& a, const query::Shape& b, const math::Pose& pose,
                               const query::Request& request, Workspace& memory) {
  return std::visit(
      [&](const auto& tree_a) {
        using Tree = std::remove_cvref_t<decltype(tree_a)>;
        return search(tree_a, *std::get_if<Tree>(&b.data().tree), a, b, pose, request, memory);
      },
      a.data().tree);
}

}  // namespace

Result<std::vector<std::vector<Unproved>>> unproved_answers(const Meeting& meeting, const Asked& asked) {
  SharedShape wide[2];
  SharedShape shapes[2];
  for (int side = 0; side < 2; ++side) {
    const std::string& name = side == 0 ? meeting.a : meeting.b;
    auto built = named_shape(name, volume::Kind::wide);
    if (!built.ok()) return built.error();
    wide[side] = shapes[side] = built.value();
    if (asked.volume == volume::Kind::wide) continue;
    auto other = named_shape(name, asked.volume);
    if (!other.ok()) return other.error();
    shapes[side] = other.value();
  }
  auto maker = report::PoseMaker::make(wide[0], wide[1], meeting.procedure, asked.seed);
  if (!maker.ok()) return maker.error();
  auto pair = query::Pair::make(wide[0], wide[1]);
  if (!pair.ok()) return pair.error();
  const std::uint64_t poses = asked.poses_per_band * report::pose_bands(meeting.procedure).size();
  Workspace memory;
  std::vector<std::vector<Unproved>> found(asked.ways.size());
  for (std::uint64_t i = 0; i < poses; ++i) {
    const auto made = maker.value().pose(i);
    if (!made.ok()) return made.error();
    const math::Pose pose = made.value().pose();
    const bool hit = pair.value().run(pose, {}).verdict == query::Verdict::hit;
    for (std::size_t way = 0; way < asked.ways.size(); ++way) {
      query::Request request;
      request.estimator = asked.ways[way].estimator;
      request.method = asked.ways[way].method;
      request.polygon_free = asked.ways[way].polygon_free;
      // The wide engine is depth-first from the beginning where it looks for several contacts.
      if (request.method == query::Method::exact) request.max_contacts = 2;
      for (const std::uint64_t units : asked.units) {
        request.budget = query::Budget::work(units);
        auto left = search(*shapes[0], *shapes[1], pose, request, memory);
        if (!left) continue;
        left->hit = hit;
        left->offset = made.value().offset;
        found[way].push_back(*left);
      }
    }
  }
  return found;
}

}  // namespace odds::calibration
