#include "ode_scenes/bullet.hpp"

#include <stdexcept>

#ifdef ODDS_WITH_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <map>
#include <vector>

namespace odds::ode_scenes {
namespace {

/// One geom: GImpact's locks want a shape for each.
struct Placed {
  Placed(dGeomID of, const mesh::TriangleMesh& mesh) : geom(of) {
    for (const Vec3& v : mesh.vertices()) {
      for (int axis = 0; axis < 3; ++axis) vertices.push_back(static_cast<btScalar>(v[axis]));
    }
    for (const mesh::Triangle& t : mesh.triangles()) indices.insert(indices.end(), t.begin(), t.end());
    arrays = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles().size()), indices.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.vertices().size()), vertices.data(), static_cast<int>(3 * sizeof(btScalar)));
    shape = std::make_unique<btGImpactMeshShape>(arrays.get());
    shape->setMargin(0);  // contacts where the surfaces are, as those of the others
    shape->updateBound();
    object.setCollisionShape(shape.get());
  }
  void follow() {
    const dReal* r = dGeomGetRotation(geom);
    const dReal* p = dGeomGetPosition(geom);
    const auto real = [](dReal x) { return static_cast<btScalar>(x); };
    object.setWorldTransform(btTransform(btMatrix3x3(real(r[0]), real(r[1]), real(r[2]), real(r[4]), real(r[5]),
                                                     real(r[6]), real(r[8]), real(r[9]), real(r[10])),
                                         btVector3(real(p[0]), real(p[1]), real(p[2]))));
  }

  dGeomID geom;
  std::vector<btScalar> vertices;
  std::vector<int> indices;
  std::unique_ptr<btTriangleIndexVertexArray> arrays;
  std::unique_ptr<btGImpactMeshShape> shape;
  btCollisionObject object;
};

struct Collected final : btManifoldResult {
  Collected(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, int room, dContact* into)
      : btManifoldResult(a, b), most(room), contacts(into) {}
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar depth) override {
    if (depth > 0 || count == most) return;
    dContactGeom& geom = contacts[count++].geom;
    geom = {};
    for (int axis = 0; axis < 3; ++axis) {
      geom.pos[axis] = static_cast<dReal>(point[axis]);
      geom.normal[axis] = static_cast<dReal>(normal[axis]);
    }
    geom.depth = -static_cast<dReal>(depth);
  }
  int most;
  dContact* contacts;
  int count = 0;
};

}  // namespace

struct Bullet::Implementation {
  Implementation() : dispatcher(&configuration) { btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher); }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    for (auto& [pair, algorithm] : algorithms) {
      algorithm->~btCollisionAlgorithm();
      dispatcher.freeCollisionAlgorithm(algorithm);
    }
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDispatcherInfo info;
  std::map<dGeomID, std::unique_ptr<Placed>> placed;
  std::map<std::pair<dGeomID, dGeomID>, btCollisionAlgorithm*> algorithms;
};

Bullet::Bullet() : implementation_(std::make_unique<Implementation>()) {}
bool Bullet::available() noexcept { return true; }
void Bullet::add(dGeomID geom, const mesh::TriangleMesh& mesh) {
  implementation_->placed[geom] = std::make_unique<Placed>(geom, mesh);
}

int Bullet::collide(dGeomID a, dGeomID b, int most, dContact* contacts) {
  Placed& first = *implementation_->placed.at(a);
  Placed& second = *implementation_->placed.at(b);
  first.follow();
  second.follow();
  const auto wrap = [](const Placed& p) {
    return btCollisionObjectWrapper(nullptr, p.shape.get(), &p.object, p.object.getWorldTransform(), -1, -1);
  };
  const btCollisionObjectWrapper of_a = wrap(first);
  const btCollisionObjectWrapper of_b = wrap(second);
  btCollisionAlgorithm*& algorithm = implementation_->algorithms[{a, b}];
  if (algorithm == nullptr) {
    algorithm = implementation_->dispatcher.findAlgorithm(&of_a, &of_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  }
  Collected result(&of_a, &of_b, most, contacts);
  algorithm->processCollision(&of_a, &of_b, implementation_->info, &result);
  for (int i = 0; i < result.count; ++i) {
    contacts[i].geom.g1 = a;
    contacts[i].geom.g2 = b;
    contacts[i].geom.side1 = contacts[i].geom.side2 = -1;
  }
  return result.count;
}

}  // namespace odds::ode_scenes
#else
namespace odds::ode_scenes {

struct Bullet::Implementation {};
Bullet::Bullet() { throw std::runtime_error("this program was built without Bullet"); }
bool Bullet::available() noexcept { return false; }
void Bullet::add(dGeomID, const mesh::TriangleMesh&) {}
int Bullet::collide(dGeomID, dGeomID, int, dContact*) { return 0; }

}  // namespace odds::ode_scenes
#endif

namespace odds::ode_scenes {
Bullet::~Bullet() = default;
}  // namespace odds::ode_scenes
