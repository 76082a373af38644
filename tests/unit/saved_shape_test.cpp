// Shapes written and read again: the same bits, from memory and from files, with their polygons and without.
#include "odds/query/saved_shape.hpp"

#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "odds/query/ray.hpp"
#include "support/all_kinds.hpp"
#include "support/saved_bytes.hpp"
#include "support/shapes.hpp"
#include "support/temporary_folder.hpp"

namespace odds::query {
namespace {

using SharedShape = std::shared_ptr<const Shape>;
using testing::load;
using testing::saved_bytes;
using testing::TemporaryFolder;

SharedShape built(volume::Kind kind, std::uint32_t rings = 6) {
  return Shape::build(testing::wavy_sphere(rings, 0.3), {.volume = kind}).value();
}

SharedShape loaded(const SharedShape& shape) {
  auto again = load(saved_bytes(*shape));
  EXPECT_TRUE(again.ok()) << again.error().message();
  return again.value();
}

math::Pose some_pose(math::Random& random) {
  const Vec3 direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return math::Pose::from_quaternion(random.uniform(1.7, 2.4) * direction.normalized(), random.rotation());
}

void expect_same(const Contact& a, const Contact& b) {
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.triangle_a, b.triangle_a);
  EXPECT_EQ(a.triangle_b, b.triangle_b);
}

void expect_same(const Answer& a, const Answer& b) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.basis, b.basis);
  EXPECT_EQ(a.probability, b.probability);
  EXPECT_EQ(a.cost.node_pairs, b.cost.node_pairs);
  EXPECT_EQ(a.cost.triangle_pairs, b.cost.triangle_pairs);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) expect_same(a.contacts[i], b.contacts[i]);
  ASSERT_EQ(a.has_cell_pair, b.has_cell_pair);
  if (a.has_cell_pair) expect_same(a.cell_pair, b.cell_pair);
}

/// Every method, estimator and a limit, at poses around first touch.
void expect_same_answers(const SharedShape& shape, const SharedShape& again, bool polygon_free = false) {
  Pair one = std::move(Pair::make(shape, shape)).value();
  Pair other = std::move(Pair::make(again, again)).value();
  math::Random random(7);
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    const math::Pose pose = some_pose(random);
    for (const Method method : {Method::exact, Method::incremental, Method::time_critical}) {
      for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
        for (const std::uint64_t work : {60U, 100000U}) {
          Request request;
          request.method = method;
          request.estimator = estimator;
          request.budget = Budget::work(work);
          request.max_contacts = 4;
          request.polygon_free = polygon_free;
          const Answer& expected = one.run(pose, request);
          hits += expected.verdict == Verdict::hit ? 1 : 0;
          request.polygon_free = false;
          expect_same(expected, other.run(pose, request));
        }
      }
    }
  }
  EXPECT_GT(hits, 40);
  EXPECT_LT(hits, 460);  // of 480
}

class SavedShape : public ::testing::TestWithParam<volume::Kind> {};

TEST_P(SavedShape, IsTheSameInEveryByteWhenItIsWrittenAgain) {
  const SharedShape shape = built(GetParam());
  EXPECT_EQ(saved_bytes(*loaded(shape)), saved_bytes(*shape));
}

TEST_P(SavedShape, AnswersWithTheSameBits) {
  const SharedShape shape = built(GetParam());
  const SharedShape again = loaded(shape);
  expect_same_answers(shape, again);
  math::Random random(3);
  for (int i = 0; i < 50; ++i) {
    const math::Pose pose = some_pose(random);
    const Vec3 direction = -pose.translation.normalized();
    const auto hit = cast_ray(*shape, pose.translation, direction, 9.0);
    const auto hit_again = cast_ray(*again, pose.translation, direction, 9.0);
    ASSERT_EQ(hit.has_value(), hit_again.has_value());
    if (hit) {
      EXPECT_EQ(hit->distance, hit_again->distance);
      EXPECT_EQ(hit->triangle, hit_again->triangle);
    }
    std::uint32_t found[64];
    std::uint32_t found_again[64];
    bool complete = false;
    const Vec3 half(0.4, 0.5, 0.6);
    const std::size_t count =
        triangles_in_box(*shape, 0.5 * pose.translation, pose.rotation, half, found, 10000, &complete);
    ASSERT_EQ(triangles_in_box(*again, 0.5 * pose.translation, pose.rotation, half, found_again, 10000, &complete),
              count);
    EXPECT_TRUE(std::equal(found, found + count, found_again));
  }
}

TEST_P(SavedShape, KeepsWhatIsKnownAboutIt) {
  const SharedShape shape = built(GetParam());
  const SharedShape again = loaded(shape);
  EXPECT_EQ(again->volume(), GetParam());
  EXPECT_EQ(again->is_solid(), shape->is_solid());
  EXPECT_EQ(again->mesh().name(), "wavy sphere");
  EXPECT_EQ(again->mesh().lower(), shape->mesh().lower());
  EXPECT_EQ(again->options().leaf_triangles, shape->options().leaf_triangles);
  EXPECT_EQ(again->options().tau, shape->options().tau);
  const ShapeSummary& a = shape->summary();
  const ShapeSummary& b = again->summary();
  EXPECT_EQ(std::tie(a.triangles, a.nodes, a.leaves, a.depth, a.bytes, a.mesh_bytes, a.polygon_free_bytes, a.build_ms),
            std::tie(b.triangles, b.nodes, b.leaves, b.depth, b.bytes, b.mesh_bytes, b.polygon_free_bytes, b.build_ms));
  EXPECT_EQ(a.mean_leaf_triangles, b.mean_leaf_triangles);
  EXPECT_EQ(a.mean_well_filled_cells, b.mean_well_filled_cells);
  EXPECT_EQ(a.load_ms, 0.0);
  EXPECT_GT(b.load_ms, 0.0);
}

TEST_P(SavedShape, OfTheOtherByteOrderIsRead) {
  const std::string bytes = saved_bytes(*built(GetParam(), 3));
  const std::string swapped = testing::other_byte_order(bytes);
  ASSERT_NE(swapped, bytes);
  const auto shape = load(swapped);
  ASSERT_TRUE(shape.ok()) << shape.error().message();
  EXPECT_EQ(saved_bytes(*shape.value()), bytes);
}

TEST_P(SavedShape, OfDegenerateAndFarMeshesIsRead) {
  const std::vector<Vec3> point(3, Vec3(5, 5, 5));
  const std::vector<Vec3> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<Vec3> huge = {{-1e15, 0, 0}, {1e15, 1e15, 0}, {0, 0, 1e15}};
  const std::vector<Vec3> tiny = {{0, 0, 0}, {1e-300, 0, 0}, {0, 1e-300, 0}};
  for (const auto& corners : {point, line, huge, tiny}) {
    auto mesh = mesh::TriangleMesh::make(corners, {{0, 1, 2}, {2, 1, 0}});
    ASSERT_TRUE(mesh.ok());
    const auto shared = std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
    const SharedShape shape = Shape::build(shared, {.volume = GetParam()}).value();
    EXPECT_EQ(saved_bytes(*loaded(shape)), saved_bytes(*shape));
  }
}

TEST_P(SavedShape, WithoutPolygonsAnswersAsAPolygonFreeRequest) {
  const SharedShape shape = built(GetParam(), 8);
  const SharedShape dropped = shape->without_polygons();
  EXPECT_FALSE(dropped->has_polygons());
  EXPECT_EQ(dropped->summary().bytes, shape->summary().polygon_free_bytes);
  EXPECT_LT(dropped->summary().bytes, shape->summary().bytes);
  EXPECT_LT(saved_bytes(*dropped).size(), saved_bytes(*shape).size());
  expect_same_answers(shape, dropped, true);
  expect_same_answers(shape, loaded(dropped), true);
  EXPECT_EQ(saved_bytes(*loaded(dropped)), saved_bytes(*dropped));
}

TEST_P(SavedShape, WithoutPolygonsNeverProvesAHitAndFindsNoTriangles) {
  const SharedShape shape = built(GetParam());
  const SharedShape dropped = shape->without_polygons();
  Pair pair = std::move(Pair::make(shape, dropped)).value();
  const Answer& answer = pair.run({}, {.method = Method::exact, .max_contacts = 8});  // one on the other
  EXPECT_EQ(answer.basis, Basis::estimated);
  EXPECT_GT(answer.probability, 0.1);
  EXPECT_LT(answer.probability, 1.0);
  EXPECT_TRUE(answer.contacts.empty());
  EXPECT_FALSE(pair.distance({}).proved);
  EXPECT_EQ(pair.distance({}).triangle_a, no_feature);
  EXPECT_FALSE(cast_ray(*dropped, {9, 0, 0}, {-1, 0, 0}, 20.0).has_value());
  std::uint32_t found[8];
  bool complete = true;
  EXPECT_EQ(triangles_in_box(*dropped, Vec3::Zero(), Mat3::Identity(), Vec3::Ones(), found, 1000, &complete), 0u);
  EXPECT_FALSE(complete);
  EXPECT_EQ(dropped->mesh().upper(), shape->mesh().upper());
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, SavedShape, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return testing::name_of(tested.param); });

TEST(SavedShapeFile, IsMappedAndOutlivesItsName) {
  const TemporaryFolder folder;
  const std::string path = folder / "sphere.odds";
  const SharedShape shape = built(volume::Kind::wide);
  ASSERT_FALSE(save_shape(*shape, path).has_value());
  EXPECT_TRUE(is_saved_shape(path));
  const auto again = load_shape(path);
  ASSERT_TRUE(again.ok()) << again.error().message();
  ASSERT_FALSE(save_shape(*built(volume::Kind::aabb), path).has_value());  // replaces the file, not what is mapped
  EXPECT_EQ(saved_bytes(*again.value()), saved_bytes(*shape));
  std::filesystem::remove(path);
  expect_same_answers(shape, again.value());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SavedShapeFile, IsNotLeftInPieces) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  for (const std::string& path : {folder / "no such folder/x.odds", folder / "file/x.odds", folder.path().string()}) {
    const auto error = save_shape(*built(volume::Kind::wide), path);
    ASSERT_TRUE(error.has_value()) << path;
    EXPECT_EQ(error->file, path);
    EXPECT_FALSE(error->remedy.empty());
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1u);
}

}  // namespace
}  // namespace odds::query
