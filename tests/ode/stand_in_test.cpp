// Mesh against dTriMesh and heightfield: the mesh that stands in answers as one of our own geoms would.
#include <cmath>
#include <random>

#include "ode/geom/partners.hpp"
#include "ode/trimesh_fixture.hpp"

namespace odds::test {
namespace {

class StandIn : public OdeTest {
 protected:
  std::mt19937 random{43};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

TEST_F(StandIn, ATriMeshAnswersLikeOneOfOurGeoms) {
  const auto shape = box_shape(1, 0.5, 0.25, 4);  // exact in single precision
  const dGeomID mesh = mesh_geom(sphere_shape(0.5), space);
  const dGeomID twin = mesh_geom(shape, space);
  const TriMesh trimesh(shape->mesh(), space);
  ASSERT_EQ(oddsPreparePair(mesh, trimesh.geom), 1) << oddsGetLastError();
  ASSERT_EQ(oddsPreparePair(mesh, twin), 1);
  dGeomOddsMeshSetMethod(mesh, ODDS_METHOD_EXACT);
  int hits = 0;
  for (int round = 0; round < 300; ++round) {
    const Vec3 axis(uniform(random), uniform(random), 1.5);
    const double angle = 3.0 * uniform(random);
    const Vec3 place(0.8 * uniform(random), 0.8 * uniform(random), 0.8 * uniform(random));
    for (const dGeomID geom : {twin, trimesh.geom}) {
      rotate(geom, axis, angle);
      dGeomSetPosition(geom, place.x(), place.y(), place.z());
    }
    const auto expected = collide(mesh, twin);
    const auto forward = collide(mesh, trimesh.geom);
    const auto backward = collide(trimesh.geom, mesh);
    expect_sound(forward, mesh, trimesh.geom);
    expect_sound(backward, trimesh.geom, mesh);
    ASSERT_EQ(forward.size(), expected.size()) << "round " << round;
    ASSERT_EQ(backward.empty(), expected.empty()) << "round " << round;
    hits += expected.empty() ? 0 : 1;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(forward[i].depth, expected[i].depth, 1e-6);
      EXPECT_LT((normal_of(forward[i]) - normal_of(expected[i])).norm(), 1e-5);
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_EQ(stats().lazy_pairs, 0u);
  EXPECT_EQ(stats().lazy_partners, 0u);
  EXPECT_EQ(stats().changed_partners, 0u);
  oddsAnswer answer;
  EXPECT_EQ(oddsGetLastAnswer(trimesh.geom, mesh, &answer), 1) << oddsGetLastError();
}

TEST_F(StandIn, AnUnpreparedTriMeshIsReadInTheFirstCollisionAndCounted) {
  const auto shape = sphere_shape(0.5, 4);
  const dGeomID mesh = mesh_geom(shape, space);
  const TriMesh trimesh(shape->mesh(), space);
  dGeomSetPosition(trimesh.geom, 0.9, 0, 0);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(collide(mesh, trimesh.geom).empty());
  EXPECT_EQ(stats().lazy_partners, 1u);
  EXPECT_EQ(stats().lazy_pairs, 1u);
  EXPECT_EQ(stats().live_partners, 1u);
}

TEST_F(StandIn, GeomsOfOneDataShareOneHierarchyAndKeepTheirSettingsApart) {
  const auto shape = sphere_shape(0.5, 4);
  const TriMesh trimesh(shape->mesh(), space);
  const dGeomID second = dCreateTriMesh(space, trimesh.data, nullptr, nullptr, nullptr);
  ASSERT_EQ(oddsPrepareTriMesh(trimesh.geom, nullptr), 1);
  ASSERT_EQ(oddsPrepareTriMesh(second, nullptr), 1);
  EXPECT_EQ(dGeomOddsMeshSetBudget(second, 20), 1) << oddsGetLastError();
  EXPECT_EQ(dGeomOddsMeshGetBudget(second), 20);
  EXPECT_EQ(dGeomOddsMeshGetBudget(trimesh.geom), dInfinity);
  EXPECT_EQ(stats().live_partners, 2u);
  EXPECT_EQ(oddsForgetGeom(second), 1);
}

// A program that makes and destroys a geom of the same data in every step had its hierarchy built in every step.
TEST_F(StandIn, AHierarchyThatIsKeptIsThatOfTheNextGeomUntilItsDataEnds) {
  const auto prepare = [](dGeomID geom) {
    EXPECT_EQ(oddsPrepareTriMesh(geom, nullptr), 1);
    return std::weak_ptr<const ode::PreparedMesh>(ode::partner_table().find(geom)->mesh->mesh);
  };
  for (const bool keep : {false, true}) {
    ode::keep_hierarchies(keep);
    std::weak_ptr<const ode::PreparedMesh> first;
    {
      TriMesh mesh(box_shape(1, 1, 1)->mesh(), nullptr);
      first = prepare(mesh.geom);
      oddsForgetGeom(mesh.geom);
      EXPECT_EQ(first.expired(), !keep);
      dGeomDestroy(mesh.geom);
      mesh.geom = dCreateTriMesh(nullptr, mesh.data, nullptr, nullptr, nullptr);
      EXPECT_EQ(prepare(mesh.geom).lock() == first.lock(), keep);
      mesh.vertices[0] *= 2.0;
      dGeomTriMeshDataBuildDouble(mesh.data, mesh.vertices.data(), 3 * sizeof(double), 8, mesh.indices.data(),
                                  static_cast<int>(mesh.indices.size()), 3 * sizeof(dTriIndex));
      EXPECT_NE(prepare(mesh.geom).lock(), first.lock()) << "other data at the same address";
      EXPECT_TRUE(first.expired());
      first = prepare(mesh.geom);
      ode::note_destroyed(mesh.data);
    }
    EXPECT_TRUE(first.expired());
  }
  ode::keep_hierarchies(false);
}

// The hierarchy of the first call was shared, whatever the second one asked for, were it nonsense.
TEST_F(StandIn, OtherParametersOfOneDataBuildAnotherHierarchy) {
  const auto shape = sphere_shape(0.5, 8);
  const TriMesh trimesh(shape->mesh(), space);
  const auto leaves = [&](int leaf_triangles) {
    oddsBuildParams params;
    oddsBuildParamsInit(&params);
    params.leaf_triangles = leaf_triangles;
    EXPECT_EQ(oddsPrepareTriMesh(trimesh.geom, &params), 1) << oddsGetLastError();
    return ode::partner_table().find(trimesh.geom)->mesh->mesh->shape->summary().leaves;
  };
  const std::size_t large = leaves(8);
  EXPECT_GT(leaves(1), large);
  EXPECT_EQ(leaves(8), large);
  oddsBuildParams params;
  oddsBuildParamsInit(&params);
  params.leaf_triangles = 99;
  EXPECT_EQ(oddsPrepareTriMesh(trimesh.geom, &params), 0);
  oddsBuildParamsInit(&params);
  params.tau = NAN;
  EXPECT_EQ(oddsPrepareTriMesh(trimesh.geom, &params), 0);
}

TEST_F(StandIn, AMeshIsReadWithTheVolumeOfTheOneThatItIsPreparedWith) {
  const auto shape = box_shape(1, 1, 1);
  const TriMesh known(shape->mesh(), space);
  const TriMesh other(shape->mesh(), space);
  const TriMesh third(shape->mesh(), space);
  oddsBuildParams params;
  oddsBuildParamsInit(&params);
  params.volume = ODDS_VOLUME_AABB;
  ASSERT_EQ(oddsPrepareTriMesh(known.geom, &params), 1) << oddsGetLastError();
  EXPECT_EQ(oddsPreparePair(known.geom, other.geom), 1) << oddsGetLastError();
  EXPECT_EQ(oddsPreparePair(third.geom, known.geom), 1) << oddsGetLastError();
}

TEST_F(StandIn, AMeshThatWasDeformedIsFoundOutAndCanBePreparedAgain) {
  const auto shape = box_shape(1, 1, 1, 1);
  const dGeomID mesh = mesh_geom(shape, space);
  TriMesh trimesh(shape->mesh(), space);
  dGeomSetPosition(trimesh.geom, 0.9, 0, 0);
  ASSERT_EQ(oddsPreparePair(mesh, trimesh.geom), 1);
  EXPECT_FALSE(collide(mesh, trimesh.geom).empty());
  for (double& coordinate : trimesh.vertices) coordinate *= 2.0;
  dGeomTriMeshDataBuildDouble(trimesh.data, trimesh.vertices.data(), 3 * sizeof(double), 8, trimesh.indices.data(),
                              static_cast<int>(trimesh.indices.size()), 3 * sizeof(dTriIndex));
  EXPECT_TRUE(collide(mesh, trimesh.geom).empty());
  EXPECT_EQ(stats().changed_partners, 1u);
  ASSERT_EQ(oddsPreparePair(mesh, trimesh.geom), 1) << "reads it again";
  EXPECT_FALSE(collide(mesh, trimesh.geom).empty());
  EXPECT_EQ(stats().changed_partners, 1u);
}

// A mesh whose vertices move has to be read again: it had no budget from then on, and eight contacts.
TEST_F(StandIn, AMeshThatIsReadAgainKeepsItsSettings) {
  const auto shape = box_shape(1, 1, 1, 1);
  const dGeomID mesh = mesh_geom(shape, space);
  TriMesh trimesh(shape->mesh(), space);
  const auto expect_kept = [&](const char* after) {
    EXPECT_EQ(dGeomOddsMeshGetBudget(trimesh.geom), 20) << after;
    EXPECT_EQ(dGeomOddsMeshGetMaxContacts(trimesh.geom), 4) << after;
    EXPECT_EQ(dGeomOddsMeshGetLateContacts(trimesh.geom), 0) << after;
  };
  ASSERT_EQ(oddsPreparePair(mesh, trimesh.geom), 1) << oddsGetLastError();
  dGeomOddsMeshSetBudget(trimesh.geom, 20);
  dGeomOddsMeshSetMaxContacts(trimesh.geom, 4);
  dGeomOddsMeshSetLateContacts(trimesh.geom, 0);
  trimesh.vertices[0] -= 0.5;
  ASSERT_EQ(oddsPrepareTriMesh(trimesh.geom, nullptr), 1) << oddsGetLastError();
  expect_kept("oddsPrepareTriMesh");
  trimesh.vertices[0] -= 0.5;
  for (int i = 0; i < 12; ++i) static_cast<void>(collide(mesh, trimesh.geom));  // finds the corner
  ASSERT_GT(stats().changed_partners, 0u);
  ASSERT_EQ(oddsPreparePair(mesh, trimesh.geom), 1) << oddsGetLastError();
  expect_kept("oddsPreparePair");
  const oddsMeshDataID data = oddsMeshDataCreate();
  ASSERT_EQ(oddsMeshDataBuildFromTriMesh(data, trimesh.geom, nullptr), 1) << oddsGetLastError();
  ASSERT_EQ(oddsSetStandIn(trimesh.geom, data, 1), 1) << oddsGetLastError();
  expect_kept("oddsSetStandIn");
  oddsMeshDataDestroy(data);
  ASSERT_EQ(oddsForgetGeom(trimesh.geom), 1);
  ASSERT_EQ(oddsPrepareTriMesh(trimesh.geom, nullptr), 1) << oddsGetLastError();
  EXPECT_EQ(dGeomOddsMeshGetBudget(trimesh.geom), dInfinity) << "what was forgotten has none";
}

TEST_F(StandIn, OurOwnDoublesMayStandInForATriMesh) {
  const auto shape = sphere_shape(0.3, 4);  // not exact in single precision
  const TriMesh trimesh(shape->mesh(), space);
  const oddsMeshDataID data = oddsMeshDataCreate();
  ASSERT_EQ(oddsMeshDataBuildDouble(data, trimesh.vertices.data(), 3 * sizeof(double),
                                    static_cast<int>(trimesh.vertices.size() / 3), trimesh.indices.data(),
                                    static_cast<int>(trimesh.indices.size()), 3 * sizeof(dTriIndex), nullptr),
            1);
  EXPECT_EQ(oddsSetStandIn(trimesh.geom, data, 1), 1) << oddsGetLastError();
  EXPECT_EQ(oddsSetStandIn(dCreateSphere(space, 1), data, 1), 0);
  EXPECT_EQ(oddsSetStandIn(trimesh.geom, nullptr, 1), 0);
  oddsMeshDataDestroy(data);
  const dGeomID mesh = mesh_geom(shape, space);
  dGeomSetPosition(mesh, 0.5, 0, 0);
  EXPECT_FALSE(collide(trimesh.geom, mesh).empty());
}

dReal slope(void*, int x, int z) { return 0.5 * x + 0.25 * z; }
dReal hills(void*, int x, int z) { return std::sin(1.3 * x) + std::cos(0.7 * z); }

oddsHeightfield field_of(dHeightfieldGetHeight* height, double thickness) {
  oddsHeightfield field = {};
  field.height = height;
  field.width = 4;
  field.depth = 6;
  field.width_samples = 9;
  field.depth_samples = 13;
  field.scale = 0.2;
  field.offset = 0.1;
  field.thickness = thickness;
  return field;
}

TEST_F(StandIn, AHeightfieldIsWhereOdesRaysMeetIt) {
  const oddsHeightfield field = field_of(&hills, 1.0);
  const dHeightfieldDataID odes = dGeomHeightfieldDataCreate();
  dGeomHeightfieldDataBuildCallback(odes, nullptr, field.height, field.width, field.depth, field.width_samples,
                                    field.depth_samples, field.scale, field.offset, field.thickness, 0);
  const dGeomID heightfield = dCreateHeightfield(space, odes, 1);
  const oddsMeshDataID data = oddsMeshDataCreate();
  ASSERT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 1) << oddsGetLastError();
  EXPECT_EQ(oddsMeshDataIsClosed(data), 1);
  const dGeomID mesh = dCreateOddsMesh(space, data);
  dGeomOddsMeshSetBudget(mesh, dInfinity);
  const dGeomID ray = dCreateRay(space, 10);
  dGeomRaySetClosestHit(ray, 1);
  for (int round = 0; round < 300; ++round) {
    const double x = 1.9 * uniform(random);
    const double z = 2.9 * uniform(random);
    dGeomRaySet(ray, x, 5, z, 0, -1, 0);
    const auto ours = collide(ray, mesh);
    const auto theirs = collide(ray, heightfield);
    ASSERT_EQ(ours.size(), 1u);
    ASSERT_EQ(theirs.size(), 1u);
    EXPECT_NEAR(ours[0].depth, theirs[0].depth, 1e-9) << x << ", " << z;
    EXPECT_LT((normal_of(ours[0]) - normal_of(theirs[0])).norm(), 1e-9) << "upwards, out of the ground";
  }
  oddsMeshDataDestroy(data);
  dGeomDestroy(heightfield);
  dGeomHeightfieldDataDestroy(odes);
}

TEST_F(StandIn, AMeshRestsOnAHeightfieldWithAndWithoutAPose) {
  const oddsHeightfield field = field_of(&slope, 1.0);
  const dHeightfieldDataID odes = dGeomHeightfieldDataCreate();
  dGeomHeightfieldDataBuildCallback(odes, nullptr, field.height, field.width, field.depth, field.width_samples,
                                    field.depth_samples, field.scale, field.offset, field.thickness, 0);
  const oddsMeshDataID data = oddsMeshDataCreate();
  ASSERT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 1);
  // y = 0.1 + 0.2 (0.5 (x + 2) / 0.5 + 0.25 (z + 3) / 0.5)
  const Vec3 up = Vec3(-0.2, 1.0, -0.1).normalized();
  const dGeomID mesh = mesh_geom(sphere_shape(0.5, 16), space);
  for (const int placeable : {0, 1}) {
    const dGeomID heightfield = dCreateHeightfield(space, odes, placeable);
    ASSERT_EQ(oddsSetStandIn(heightfield, data, placeable), 1) << oddsGetLastError();
    ASSERT_EQ(oddsPreparePair(mesh, heightfield), 1) << oddsGetLastError();
    Vec3 ground(0.3, 0.1 + 0.2 * 2.3 + 0.1 * 3.2, 0.2);
    if (placeable != 0) {
      dGeomSetPosition(heightfield, 0, 1, 0);
      ground.y() += 1.0;
    }
    const Vec3 center = ground + 0.49 * up;
    dGeomSetPosition(mesh, center.x(), center.y(), center.z());
    for (const auto& contacts : {collide(mesh, heightfield), collide(heightfield, mesh)}) {
      ASSERT_FALSE(contacts.empty());
      const double sign = contacts[0].g1 == mesh ? 1.0 : -1.0;
      EXPECT_GT(sign * normal_of(contacts[0]).dot(up), 0.999);
      EXPECT_NEAR(contacts[0].depth, 0.01, 0.003) << "a tessellated ball";
    }
    EXPECT_EQ(stats().lazy_pairs, 0u);
    oddsForgetGeom(heightfield);
    dGeomDestroy(heightfield);
  }
  oddsMeshDataDestroy(data);
  dGeomHeightfieldDataDestroy(odes);
}

TEST_F(StandIn, AMeshDoesNotStandInForOtherData) {
  const auto shape = box_shape(1, 1, 1);
  const TriMesh trimesh(shape->mesh(), space);
  const TriMesh other(box_shape(0.1, 0.1, 0.1)->mesh(), space);
  const oddsMeshDataID data = oddsMeshDataCreate();
  ASSERT_EQ(oddsMeshDataBuildFromTriMesh(data, trimesh.geom, nullptr), 1);
  ASSERT_EQ(oddsSetStandIn(trimesh.geom, data, 1), 1);
  oddsMeshDataDestroy(data);
  const dGeomID mesh = mesh_geom(shape, space);
  dGeomSetPosition(mesh, 0.9, 0, 0);
  EXPECT_FALSE(collide(mesh, trimesh.geom).empty());
  dGeomTriMeshSetData(trimesh.geom, other.data);  // as of another geom at its address
  EXPECT_TRUE(collide(mesh, trimesh.geom).empty());
  EXPECT_EQ(stats().changed_partners, 1u);
}

// Its ground was another from then on, and things still stood on the old one.
TEST_F(StandIn, AMeshDoesNotStandInForOtherHeights) {
  const oddsHeightfield field = field_of(&slope, 1.0);
  std::array<dHeightfieldDataID, 2> odes = {};
  for (dHeightfieldDataID& one : odes) {
    one = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildCallback(one, nullptr, field.height, field.width, field.depth, field.width_samples,
                                      field.depth_samples, field.scale, field.offset, field.thickness, 0);
  }
  const oddsMeshDataID data = oddsMeshDataCreate();
  ASSERT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 1);
  const dGeomID mesh = mesh_geom(sphere_shape(0.5), space);
  dGeomSetPosition(mesh, 0.3, 1.1, 0.2);
  const dGeomID heightfield = dCreateHeightfield(space, odes[0], 0);
  EXPECT_EQ(oddsPreparePair(mesh, heightfield), 0) << "nothing stands in for it yet: it would have no contacts";
  ASSERT_EQ(oddsSetStandIn(heightfield, data, 0), 1) << oddsGetLastError();
  EXPECT_FALSE(collide(mesh, heightfield).empty());
  dGeomHeightfieldSetHeightfieldData(heightfield, odes[1]);
  EXPECT_TRUE(collide(mesh, heightfield).empty());
  EXPECT_EQ(stats().changed_partners, 1u);
  EXPECT_EQ(oddsPreparePair(heightfield, mesh), 0) << "nor for these heights";
  ASSERT_EQ(oddsSetStandIn(heightfield, data, 0), 1) << oddsGetLastError();
  EXPECT_FALSE(collide(mesh, heightfield).empty());
  oddsForgetGeom(heightfield);
  dGeomDestroy(heightfield);
  oddsMeshDataDestroy(data);
  for (const dHeightfieldDataID one : odes) dGeomHeightfieldDataDestroy(one);
}

// Two were destroyed and not forgotten, and geoms of other classes made at their addresses: ODE ended the program where
// such a sphere was asked for its triangles.
TEST_F(StandIn, AGeomOfAnotherClassAtAKnownAddressIsAnotherGeom) {
  const auto shape = box_shape(1, 1, 1);
  const dGeomID mesh = mesh_geom(shape, space);
  const dGeomID sphere = dCreateSphere(space, 0.3);
  {
    const TriMesh gone(shape->mesh(), space);
    ASSERT_EQ(oddsPrepareTriMesh(gone.geom, nullptr), 1);
    auto known = ode::make_partner(gone.geom, ode::partner_table().find(gone.geom)->mesh->mesh);
    known->trimesh_data = gone.data;
    known->geom = sphere;
    ode::partner_table().put(std::move(known));
  }
  EXPECT_EQ(oddsPreparePair(mesh, sphere), 1) << oddsGetLastError();
  EXPECT_EQ(dGeomOddsMeshSetBudget(sphere, 20), 0) << "it has no mesh";
  dGeomSetPosition(sphere, 0, 0, 0.7);
  EXPECT_EQ(collide(mesh, sphere).size(), 1u);

  const TriMesh late(shape->mesh(), space);
  dGeomSetPosition(late.geom, 0.9, 0, 0);
  auto known = ode::make_partner(sphere, nullptr);
  known->geom = late.geom;
  ode::partner_table().put(std::move(known));
  EXPECT_TRUE(collide(mesh, late.geom).empty());
  EXPECT_EQ(stats().changed_partners, 1u);
  EXPECT_EQ(stats().lazy_partners, 0u);
  EXPECT_EQ(oddsPreparePair(mesh, late.geom), 1) << "reads it";
  EXPECT_FALSE(collide(mesh, late.geom).empty());
  EXPECT_EQ(oddsForgetGeom(sphere), 1);
}

TEST_F(StandIn, HeightfieldsOutOfRangeAreRefused) {
  const oddsMeshDataID data = oddsMeshDataCreate();
  oddsHeightfield field = field_of(&slope, 0.0);
  EXPECT_EQ(oddsMeshDataBuildHeightfield(data, nullptr, nullptr), 0);
  EXPECT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 1);
  EXPECT_EQ(oddsMeshDataIsClosed(data), 0) << "without thickness it is a sheet";
  field.width_samples = 1;
  EXPECT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 0);
  field = field_of([](void*, int, int) -> dReal { return NAN; }, 0.0);
  EXPECT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 0);
  field = field_of(nullptr, 0.0);
  EXPECT_EQ(oddsMeshDataBuildHeightfield(data, &field, nullptr), 0);
  EXPECT_NE(std::string(oddsGetLastError()).find("oddsMeshDataBuildHeightfield"), std::string::npos);
  oddsMeshDataDestroy(data);
}

}  // namespace
}  // namespace odds::test
