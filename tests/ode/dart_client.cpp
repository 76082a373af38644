// A program that knows DART only: two mesh bricks on the ground, ten seconds at 1 kHz, collided by DART's ODE detector.
// Prints how far the bricks went from their places and what a step took. tests/ode/dart builds and runs it.
#include <dart/collision/ode/OdeCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/MeshShape.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

using namespace dart::dynamics;

const Eigen::Vector3d brick(0.2, 0.5, 0.248);
const Eigen::Vector3d ground(4.0, 4.0, 1.0);

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// A box of `cells` cells along each edge, as a file, since DART reads meshes from files.
std::string box_file(const Eigen::Vector3d& size, int cells) {
  const std::string name = "box_" + std::to_string(cells) + "_" + std::to_string(size.x()) + ".obj";
  std::ofstream file(name);
  file.precision(17);
  int corners = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-0.5, 0.5}) {
      for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
          Eigen::Vector3d p;
          p[axis] = side * size[axis];
          p[u] = (static_cast<double>(i) / cells - 0.5) * size[u];
          p[v] = (static_cast<double>(j) / cells - 0.5) * size[v];
          file << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
        }
      }
      const auto at = [&](int i, int j) { return corners + 1 + i * (cells + 1) + j; };
      const auto face = [&](int a, int b, int c) {
        if (side < 0.0) std::swap(b, c);
        file << "f " << a << ' ' << b << ' ' << c << '\n';
      };
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
          face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
      corners += (cells + 1) * (cells + 1);
    }
  }
  return name;
}

ShapePtr mesh_of(const Eigen::Vector3d& size, int cells) {
  const std::string name = box_file(size, cells);
  const aiScene* scene = MeshShape::loadMesh(std::filesystem::absolute(name));
  if (scene == nullptr) {
    std::fprintf(stderr, "error: %s: DART cannot read it\n", name.c_str());
    std::exit(1);
  }
  return std::make_shared<MeshShape>(Eigen::Vector3d::Ones(), scene);
}

SkeletonPtr body_of(const std::string& name, const ShapePtr& shape, const Eigen::Vector3d& size,
                    const Eigen::Vector3d& place, bool moves) {
  const SkeletonPtr skeleton = Skeleton::create(name);
  BodyNode* node = nullptr;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = place;
  if (moves) {
    const auto [joint, body] = skeleton->createJointAndBodyNodePair<FreeJoint>();
    Inertia inertia;
    inertia.setMass(1000.0 * size.prod());
    inertia.setMoment(BoxShape::computeInertia(size, inertia.getMass()));
    body->setInertia(inertia);
    FreeJoint::setTransform(joint, pose);
    node = body;
  } else {
    const auto [joint, body] = skeleton->createJointAndBodyNodePair<WeldJoint>();
    joint->setTransformFromParentBodyNode(pose);
    node = body;
  }
  node->createShapeNodeWith<CollisionAspect, DynamicsAspect>(shape);
  return skeleton;
}

void run(int cells, bool mesh_ground) {
  const auto world = dart::simulation::World::create();
  world->setTimeStep(0.001);
  world->getConstraintSolver()->setCollisionDetector(dart::collision::OdeCollisionDetector::create());
  const ShapePtr floor = mesh_ground ? mesh_of(ground, 1) : std::make_shared<BoxShape>(ground);
  world->addSkeleton(body_of("ground", floor, ground, {0.03, 0.02, -0.5 * ground.z()}, false));
  std::vector<SkeletonPtr> bricks;
  std::vector<Eigen::Vector3d> begun;
  for (int i = 0; i < 2; ++i) {
    begun.emplace_back(0.0, 0.0, brick.z() * (i + 0.5));
    bricks.push_back(body_of("brick " + std::to_string(i), mesh_of(brick, cells), brick, begun.back(), true));
    world->addSkeleton(bricks.back());
  }
  std::vector<double> step_us;
  double farthest = 0.0;
  for (int tick = 0; tick < 10000; ++tick) {
    const double before = thread_us();
    world->step();
    step_us.push_back(thread_us() - before);
    for (std::size_t i = 0; i < bricks.size(); ++i) {
      farthest = std::max(farthest, (bricks[i]->getBodyNode(0)->getTransform().translation() - begun[i]).norm());
    }
  }
  std::sort(step_us.begin(), step_us.end());
  std::printf("%d triangles on a %s: moved %.4f mm, step p50 %.1f us, p99 %.1f us, longest %.1f us\n",
              12 * cells * cells, mesh_ground ? "mesh" : "box", 1e3 * farthest, step_us[step_us.size() / 2],
              step_us[step_us.size() * 99 / 100], step_us.back());
}

}  // namespace

int main() {
  for (const int cells : {1, 8}) {
    for (const bool mesh_ground : {false, true}) run(cells, mesh_ground);
  }
  return 0;
}
