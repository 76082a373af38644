// Disjoint pairs in several threads at once: the same bits as one after the other. (Two pairs of ODE's own meshes in
// two threads abort.)
#include <atomic>
#include <thread>

#include "ode/partners_fixture.hpp"

namespace odds::test {
namespace {

constexpr int threads = 4;
constexpr int rounds = 50;

class Threads : public OdeTest {};

// Moves one partner through a mesh; all contacts of all rounds.
std::vector<dContactGeom> sweep(dGeomID mesh, dGeomID partner) {
  std::vector<dContactGeom> all;
  for (int round = 0; round < rounds; ++round) {
    const double t = static_cast<double>(round) / rounds;
    rotate(partner, Vec3(1.0, 0.3 + t, -0.5), 3.0 * t);
    dGeomSetPosition(partner, 0.8 * t - 0.4, 0.3 - 0.2 * t, 0.55 + 0.1 * t);
    for (const auto& found : {collide(mesh, partner, 8), collide(partner, mesh, 8)}) {
      all.insert(all.end(), found.begin(), found.end());
    }
  }
  return all;
}

void expect_same(const std::vector<dContactGeom>& a, const std::vector<dContactGeom>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(position_of(a[i]), position_of(b[i]));
    EXPECT_EQ(normal_of(a[i]), normal_of(b[i]));
    EXPECT_EQ(a[i].depth, b[i].depth);
  }
}

TEST_F(Threads, EveryPartnerOfAMeshOfItsOwnThread) {
  const auto shape = box_shape(1, 1, 1, 6);  // one hierarchy for all
  std::vector<std::unique_ptr<Partners>> partners;
  std::vector<dGeomID> meshes;
  for (int i = 0; i < threads; ++i) {
    partners.push_back(std::make_unique<Partners>(space));
    meshes.push_back(mesh_geom(shape, space));
    dGeomOddsMeshSetMethod(meshes.back(), ODDS_METHOD_EXACT);
    for (const dGeomID partner : partners.back()->all) oddsPreparePair(meshes.back(), partner);
  }
  const auto sweep_all = [&](std::size_t i) {
    std::vector<dContactGeom> found;
    for (const dGeomID partner : partners[i]->all) {
      const auto part = sweep(meshes[i], partner);
      found.insert(found.end(), part.begin(), part.end());
    }
    return found;
  };
  sweep_all(0);  // fills ODE's table, and lets every pair remember the end of the sweep
  std::vector<std::vector<dContactGeom>> together(threads);
  std::vector<std::thread> running;
  for (std::size_t i = 0; i < threads; ++i) {
    running.emplace_back([&, i] {
      sweep_all(i);
      together[i] = sweep_all(i);
    });
  }
  for (std::thread& thread : running) thread.join();
  for (std::size_t i = 0; i < threads; ++i) {
    SCOPED_TRACE(i);
    ASSERT_GT(together[i].size(), 500u);
    expect_same(together[i], sweep_all(i));
  }
  EXPECT_EQ(stats().lazy_pairs, 0u);
  EXPECT_EQ(stats().busy_pairs, 0u);
  EXPECT_EQ(stats().changed_partners, 0u);
}

TEST_F(Threads, PairsOfTriMeshesUnderATakeover) {
  const auto shape = sphere_shape(0.5, 6);
  std::vector<std::unique_ptr<TriMesh>> meshes;
  for (int i = 0; i < 2 * threads; ++i) meshes.push_back(std::make_unique<TriMesh>(shape->mesh(), space));
  oddsTakeOverParams params;
  oddsTakeOverParamsInit(&params);
  params.budget_us = dInfinity;
  ASSERT_EQ(oddsTakeOverTriMesh(&params), 1) << oddsGetLastError();
  const auto first = [&](std::size_t i) { return meshes[2 * i]->geom; };
  const auto second = [&](std::size_t i) { return meshes[2 * i + 1]->geom; };
  for (std::size_t i = 0; i < threads; ++i) ASSERT_EQ(oddsPreparePair(first(i), second(i)), 1) << oddsGetLastError();
  sweep(first(0), second(0));
  std::vector<std::size_t> found(threads);
  std::vector<std::thread> running;
  for (std::size_t i = 0; i < threads; ++i) {
    running.emplace_back([&, i] { found[i] = sweep(first(i), second(i)).size(); });
  }
  for (std::thread& thread : running) thread.join();
  for (std::size_t i = 0; i < threads; ++i) EXPECT_GE(found[i], 100u);
  EXPECT_EQ(stats().fallbacks, 0u);
  EXPECT_EQ(stats().busy_pairs, 0u);
  EXPECT_EQ(oddsGiveBackTriMesh(), 1);
}

// What is known of the others is freed while this thread looks for its own.
TEST_F(Threads, OtherTriMeshesComeAndGo) {
  const auto shape = sphere_shape(0.5, 3);
  const dGeomID mesh = mesh_geom(shape, space);
  std::vector<std::unique_ptr<TriMesh>> stay;
  for (int i = 0; i < 64; ++i) {
    stay.push_back(std::make_unique<TriMesh>(shape->mesh(), nullptr));
    dGeomSetPosition(stay.back()->geom, 0.7, 0.1, 0.0);
    ASSERT_EQ(oddsPreparePair(mesh, stay.back()->geom), 1) << oddsGetLastError();
    static_cast<void>(collide(mesh, stay.back()->geom));  // and ODE's own lazy work is done
  }
  std::vector<dGeomID> others;
  for (int i = 0; i < 200; ++i) others.push_back(dCreateTriMesh(nullptr, stay[0]->data, nullptr, nullptr, nullptr));
  std::atomic<bool> stop{false};
  std::atomic<int> turns{0};
  std::thread other([&] {
    dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll));
    for (; !stop.load(); ++turns) {
      for (const dGeomID geom : others) oddsPrepareTriMesh(geom, nullptr);
      for (const dGeomID geom : others) oddsForgetGeom(geom);
    }
  });
  std::size_t missed = 0;
  for (int round = 0; round < 200 || turns.load() < 3; ++round) {
    for (const auto& trimesh : stay) missed += collide(mesh, trimesh->geom).empty() ? 1 : 0;
  }
  stop = true;
  other.join();
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(stats().lazy_partners, 0u);
  for (const dGeomID geom : others) dGeomDestroy(geom);
}

}  // namespace
}  // namespace odds::test
