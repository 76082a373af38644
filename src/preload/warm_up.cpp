// Code that has never run is slow: its pages are found one by one, and all that it looks at is far away. That takes a
// tenth of a millisecond and more, which is all of a budget: the first ray of a process met nothing, and the first mesh
// that landed was held by its sides. A program that asks once got a wrong answer.
#include "preload/warm_up.hpp"

#include <array>
#include <vector>

#include "odds/mesh/made/box.hpp"
#include "odds/mesh/made/icosphere.hpp"
#include "ode/geom/takeover.hpp"
#include "preload/exit_page.hpp"

namespace odds::preload {
namespace {

// A dTriMesh in no space.
class Mesh {
 public:
  explicit Mesh(const mesh::TriangleMesh& made) : data_(dGeomTriMeshDataCreate()) {
    for (const Vec3& corner : made.vertices()) vertices_.insert(vertices_.end(), corner.data(), corner.data() + 3);
    for (const mesh::Triangle& triangle : made.triangles()) {
      indices_.insert(indices_.end(), triangle.begin(), triangle.end());
    }
    dGeomTriMeshDataBuildDouble(data_, vertices_.data(), 3 * sizeof(double), static_cast<int>(vertices_.size() / 3),
                                indices_.data(), static_cast<int>(indices_.size()), 3 * sizeof(dTriIndex));
    geom_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    oddsPrepareTriMesh(geom_, nullptr);
  }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;
  ~Mesh() {
    oddsForgetGeom(geom_);
    dGeomDestroy(geom_);
    dGeomTriMeshDataDestroy(data_);
  }
  [[nodiscard]] dGeomID geom() const noexcept { return geom_; }

 private:
  std::vector<double> vertices_;
  std::vector<dTriIndex> indices_;
  dTriMeshDataID data_;
  dGeomID geom_ = nullptr;
};

// A body that stands on the ground's top, z = 0, beside its middle: as it lands, as it lies, and above it; with all the
// time that this takes, then within the program's budget, which takes other ways.
void collide(dGeomID ground, dGeomID body, double half_height, double budget_us) noexcept {
  std::array<dContactGeom, 8> contacts;
  for (const double us : {static_cast<double>(dInfinity), budget_us}) {
    dGeomOddsMeshSetBudget(ground, us);
    if (dGeomGetClass(body) == dTriMeshClass) dGeomOddsMeshSetBudget(body, us);
    for (const double depth : {0.01, 0.02, 0.02, -0.02}) {
      const double height = half_height - depth;
      if (dGeomGetClass(body) == dRayClass)
        dGeomRaySet(body, 0.1, 0.05, height, 0, 0, -1);
      else if (dGeomGetClass(body) == dPlaneClass)
        dGeomPlaneSetParams(body, 0, 0, 1, depth - 1.0);
      else
        dGeomSetPosition(body, 0.1, 0.05, height);
      dCollide(ground, body, 8, contacts.data(), static_cast<int>(sizeof(dContactGeom)));
    }
  }
}

struct Body {
  unsigned bit;
  double half_height;
  dGeomID (*make)();
};
constexpr std::array<Body, 6> bodies = {{{ODDS_TAKE_SPHERE, 0.5, [] { return dCreateSphere(nullptr, 0.5); }},
                                         {ODDS_TAKE_BOX, 0.5, [] { return dCreateBox(nullptr, 1, 1, 1); }},
                                         {ODDS_TAKE_CAPSULE, 0.8, [] { return dCreateCapsule(nullptr, 0.3, 1); }},
                                         {ODDS_TAKE_CYLINDER, 0.5, [] { return dCreateCylinder(nullptr, 0.4, 1); }},
                                         {ODDS_TAKE_PLANE, 0.0, [] { return dCreatePlane(nullptr, 0, 0, 1, -1); }},
                                         {ODDS_TAKE_RAY, 0.5, [] { return dCreateRay(nullptr, 2); }}}};

void collide_convex(dGeomID ground, double budget_us) noexcept {
  static constexpr std::array<dReal, 12> points = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};  // of a tetrahedron
  static constexpr std::array<unsigned, 16> faces = {3, 0, 2, 1, 3, 0, 1, 3, 3, 0, 3, 2, 3, 1, 2, 3};
  constexpr dReal n = 0.57735026918962576;
  static constexpr std::array<dReal, 16> planes = {-n, n, n, n, n, -n, n, n, n, n, -n, n, -n, -n, -n, n};
  const dGeomID convex = dCreateConvex(nullptr, planes.data(), 4, points.data(), 4, faces.data());
  if (oddsRegisterConvex(convex, points.data(), 4, faces.data(), 4) != 0) collide(ground, convex, 1.0, budget_us);
  oddsForgetGeom(convex);
  dGeomDestroy(convex);
}

// What is not taken over is left alone: ODE's own colliders ask for memory of the thread, which it may not have.
void collide_all(const oddsTakeOverParams& takeover) {
  const auto block = mesh::made::make(mesh::made::Box{.x = 4, .y = 4, .z = 1, .cells = 4});
  const auto ball = mesh::made::make(mesh::made::Icosphere{.radius = 0.5, .frequency = 4});
  const auto crate = mesh::made::make(mesh::made::Box{.x = 1, .y = 1, .z = 1});
  if (!block.ok() || !ball.ok() || !crate.ok()) return;
  const Mesh ground(block.value());
  dGeomSetPosition(ground.geom(), 0, 0, -0.5);
  if ((takeover.partners & ODDS_TAKE_TRIMESH) != 0) {
    for (const auto* mesh : {&ball, &crate}) {
      const Mesh body(mesh->value());
      collide(ground.geom(), body.geom(), 0.5, takeover.budget_us);
    }
  }
  for (const Body& body : bodies) {
    if ((takeover.partners & body.bit) == 0) continue;
    const dGeomID geom = body.make();
    collide(ground.geom(), geom, body.half_height, takeover.budget_us);
    dGeomDestroy(geom);
  }
  if ((takeover.partners & ODDS_TAKE_CONVEX) != 0) collide_convex(ground.geom(), takeover.budget_us);
}

}  // namespace

void warm_up(const oddsTakeOverParams& takeover) noexcept {
  ode::observe_takeover(nullptr);
  try {
    collide_all(takeover);
  } catch (...) {  // no memory: the program's first collision is slow, that is all
  }
  oddsResetStats();
  ode::observe_takeover(&note_collision);
}

}  // namespace odds::preload
