// A program that knows ODE only: mesh bricks on a mesh ground, one second at 1 kHz. Prints how far the bricks are from
// where they were put, and how many contacts were sideways. The test of the preload library runs it with and without.
// With DEFORM set in the environment it tells ODE that it has moved the ground's vertices, with LATE_DATA it collides a
// mesh that could not be read when it was made. With CYCLES it has used ODE several times before, with a class of geoms
// of its own, and with COMMAS it sets a locale whose numbers have commas, if there is one. With ONE_RAY it collides
// nothing but one ray with one mesh, and counts the pages that the system had to bring for that; with FORKS it does so
// in a folder of its own choice, and has two children that leave as it does: one collides nothing, one a ray of its
// own. With LOOKED_UP it finds ODE's functions by itself.
#include <dlfcn.h>
#include <ode/ode.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

// In front of ODE's: with SINGLE it tells of an ODE built in single precision.
int dCheckConfiguration(const char* token) {
  if (std::strcmp(token, "ODE_double_precision") == 0) return std::getenv("SINGLE") == nullptr ? 1 : 0;
  return 1;
}

namespace {

constexpr double width = 0.2;
constexpr double depth = 0.5;
constexpr double height = 0.248;

struct Mesh {
  std::vector<double> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID data = dGeomTriMeshDataCreate();

  Mesh(double x, double y, double z) {
    for (int corner = 0; corner < 8; ++corner) {
      vertices.push_back((corner & 1) != 0 ? 0.5 * x : -0.5 * x);
      vertices.push_back((corner & 2) != 0 ? 0.5 * y : -0.5 * y);
      vertices.push_back((corner & 4) != 0 ? 0.5 * z : -0.5 * z);
    }
    indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
               2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double), 8, indices.data(), 36,
                                3 * sizeof(dTriIndex));
  }
  ~Mesh() { dGeomTriMeshDataDestroy(data); }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;
};

struct Simulation {
  dWorldID world = dWorldCreate();
  dSpaceID space = dSimpleSpaceCreate(nullptr);
  dJointGroupID joints = dJointGroupCreate(0);
  int contacts = 0;
  int sideways = 0;

  static void near(void* data, dGeomID a, dGeomID b) {
    auto* self = static_cast<Simulation*>(data);
    dContact found[16];
    const int count = dCollide(a, b, 16, &found[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      ++self->contacts;
      self->sideways += std::abs(found[i].geom.normal[2]) < 0.99;
      found[i].surface = {};
      found[i].surface.mode = dContactApprox1;
      found[i].surface.mu = 1.0;
      dJointAttach(dJointCreateContact(self->world, self->joints, &found[i]), dGeomGetBody(a), dGeomGetBody(b));
    }
  }
};

// Of a ball with a mesh whose data was built after it was made, and one that has a corner nowhere.
int contacts_of_late_data() {
  const dTriMeshDataID data = dGeomTriMeshDataCreate();
  const dGeomID late = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  std::vector<double> vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<dTriIndex> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double), 4, indices.data(), 12, 3 * sizeof(dTriIndex));
  dGeomSetPosition(late, 0, 0, 1);
  const dGeomID ball = dCreateSphere(nullptr, 1.05);
  dContactGeom found[8];
  const int count = dCollide(late, ball, 8, found, sizeof(dContactGeom));
  vertices[1] = std::nan("");
  const dGeomID broken = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  dGeomSetPosition(broken, 0, 0, 1);
  dCollide(broken, ball, 8, found, sizeof(dContactGeom));
  dGeomDestroy(broken);
  dGeomDestroy(late);
  dGeomDestroy(ball);
  dGeomTriMeshDataDestroy(data);
  return count;
}

long page_faults() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

struct OneRay {
  int contacts;
  long page_faults;  // of the collision
};

OneRay collide_one_ray() {
  dContactGeom found[8] = {};
  const Mesh floor(4, 4, 1);
  const dGeomID ground = dCreateTriMesh(nullptr, floor.data, nullptr, nullptr, nullptr);
  const dGeomID ray = dCreateRay(nullptr, 1);
  dGeomRaySet(ray, 0.1, 0.2, 1, 0, 0, -1);  // ends within
  const long before = page_faults();
  const int count = dCollide(ground, ray, 8, found, sizeof(dContactGeom));
  const long after = page_faults();
  dGeomDestroy(ray);
  dGeomDestroy(ground);
  return {count, after - before};
}

// Makes mesh data as a program does that is not linked to ODE.
bool look_up_and_build() {
  Dl_info library;
  if (dladdr(dlsym(RTLD_DEFAULT, "dWorldCreate"), &library) == 0) return false;
  void* const ode = dlopen(library.dli_fname, RTLD_NOW);
  if (ode == nullptr) return false;
  const auto init = reinterpret_cast<decltype(&dInitODE2)>(dlsym(ode, "dInitODE2"));
  const auto create = reinterpret_cast<decltype(&dGeomTriMeshDataCreate)>(dlsym(ode, "dGeomTriMeshDataCreate"));
  const auto build =
      reinterpret_cast<decltype(&dGeomTriMeshDataBuildSimple)>(dlsym(ode, "dGeomTriMeshDataBuildSimple"));
  if (init == nullptr || create == nullptr || build == nullptr || init(0) == 0) return false;
  static const std::vector<dReal> corners = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
  static const std::vector<dTriIndex> triangle = {0, 1, 2};
  build(create(), corners.data(), 3, triangle.data(), 3);
  return true;
}

void use_a_class_of_its_own() {
  dInitODE2(0);
  dGeomClass description = {};
  description.bytes = 8;
  description.collider = [](int) -> dColliderFn* { return nullptr; };
  description.aabb = &dInfiniteAABB;
  dCreateGeomClass(&description);
  dCloseODE();
}

}  // namespace

int main() {
  if (std::getenv("COMMAS") != nullptr && std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr) std::puts("commas");
  for (int i = 0; i < 6 && std::getenv("CYCLES") != nullptr; ++i) use_a_class_of_its_own();
  if (std::getenv("LOOKED_UP") != nullptr) return look_up_and_build() ? 0 : 1;
  dInitODE2(0);
  dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll));
  if (std::getenv("ONE_RAY") != nullptr) {
    const OneRay ray = collide_one_ray();
    std::printf("one_ray %d page_faults %ld\n", ray.contacts, ray.page_faults);
    dCloseODE();
    return 0;
  }
  if (std::getenv("FORKS") != nullptr) {
    std::printf("one_ray %d\n", collide_one_ray().contacts);
    std::fflush(stdout);
    if (chdir("/") != 0) return 1;
    for (const bool collides : {false, true}) {
      const pid_t child = fork();
      if (child == 0) {
        if (collides) collide_one_ray();
        std::exit(0);
      }
      waitpid(child, nullptr, 0);
    }
    dCloseODE();
    return 0;
  }
  double farthest = 0.0;
  {
    Simulation simulation;
    dWorldSetGravity(simulation.world, 0, 0, -9.81);
    const Mesh brick(width, depth, height);
    const Mesh floor(4, 4, 1);
    const dGeomID ground = dCreateTriMesh(simulation.space, floor.data, nullptr, nullptr, nullptr);
    dGeomSetPosition(ground, 0, 0, -0.5);
    std::vector<dBodyID> bodies;
    for (int i = 0; i < 2; ++i) {
      bodies.push_back(dBodyCreate(simulation.world));
      dMass mass;
      dMassSetBox(&mass, 1000, width, depth, height);
      dBodySetMass(bodies.back(), &mass);
      dGeomSetBody(dCreateTriMesh(simulation.space, brick.data, nullptr, nullptr, nullptr), bodies.back());
      dBodySetPosition(bodies.back(), 0, 0, height * (i + 0.5));
    }
    if (std::getenv("DEFORM") != nullptr) dGeomTriMeshDataUpdate(floor.data);
    for (int tick = 0; tick < 1000; ++tick) {
      dSpaceCollide(simulation.space, &simulation, &Simulation::near);
      dWorldQuickStep(simulation.world, 0.001);
      dJointGroupEmpty(simulation.joints);
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const dReal* p = dBodyGetPosition(bodies[i]);
      farthest = std::max({farthest, std::hypot(p[0], p[1]), std::abs(p[2] - height * (static_cast<double>(i) + 0.5))});
    }
    std::printf("moved_mm %.6f contacts %d sideways %d\n", 1e3 * farthest, simulation.contacts, simulation.sideways);
    dJointGroupDestroy(simulation.joints);
    dSpaceDestroy(simulation.space);
    dWorldDestroy(simulation.world);
  }
  if (std::getenv("LATE_DATA") != nullptr) std::printf("late_data %d\n", contacts_of_late_data());
  dCloseODE();
  return 0;
}
