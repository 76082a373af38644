// The functions of ODE that libodds_preload.so puts itself in front of: a program that runs under LD_PRELOAD gets a
// takeover of its dTriMesh geoms without being changed or built anew. Hierarchies are built where the program makes its
// meshes, not where they collide.
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "ode/geom/partners.hpp"
#include "ode/geom/takeover.hpp"
#include "preload/environment.hpp"
#include "preload/exit_page.hpp"
#include "preload/real_functions.hpp"
#include "preload/warm_up.hpp"

namespace odds::preload {
namespace {

// What our own library does with ODE comes here too; it is not the program's doing.
thread_local bool inside = false;

class Inside {
 public:
  Inside() noexcept : outer_(std::exchange(inside, true)) {}
  ~Inside() { inside = outer_; }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

 private:
  bool outer_;
};

std::atomic<bool> forked{false};

// What the parent has collided it tells itself.
void after_fork() noexcept {
  forked.store(true, std::memory_order_relaxed);
  forget_collisions();
}

// "page.%p" is a file for each process: those that a program starts inherit the variable.
std::string with_process(std::string path) {
  const std::string number = std::to_string(getpid());
  for (std::size_t at = 0; (at = path.find("%p", at)) != std::string::npos; at += number.size()) {
    path.replace(at, 2, number);
  }
  return path;
}

// Reads the environment once; says the page when the program ends.
class Session {
 public:
  Session() : environment_(read_environment()) {
    for (const std::string& mistake : environment_.mistakes) {
      std::fprintf(stderr, "warning: libodds_preload: %s\n", mistake.c_str());
    }
    fits_ = dCheckConfiguration("ODE_double_precision") != 0;
    if (!fits_) {
      std::fputs("warning: libodds_preload: no takeover: this ODE was built in single precision\n", stderr);
      return;
    }
    ode::observe_takeover(&note_collision);
    pthread_atfork(nullptr, nullptr, &after_fork);
    ode::keep_hierarchies(true);  // for programs that make a geom of the same data again and again
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    try {
      say();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "warning: libodds_preload: no report: %s\n", error.what());
    }
  }
  // Before the program's first mesh: one without meshes has no use for it.
  void warm_up_once() {
    std::call_once(warmed_, [this] { warm_up(environment_.takeover); });
  }
  void take_over() noexcept {
    if (!fits_) return;
    if (oddsTakeOverTriMesh(&environment_.takeover) == 0) {
      std::fprintf(stderr, "warning: libodds_preload: no takeover: %s\n", oddsGetLastError());
    }
  }

 private:
  void say() const {
    if (!fits_ || environment_.report == "off") return;
    if (forked.load(std::memory_order_relaxed) && !has_collisions()) return;  // would take the place of the parent's
    const std::string page = exit_page();
    if (environment_.report == "-") {
      std::fputs(page.c_str(), stderr);
      return;
    }
    const std::string path = with_process(environment_.report);
    std::ofstream file(path);
    file << page;
    if (!file.flush()) {
      std::fprintf(stderr, "warning: libodds_preload: %s cannot be written; set ODDS_REPORT to another file\n%s",
                   path.c_str(), page.c_str());
    }
  }

  Environment environment_;
  bool fits_ = true;  // the program's ODE counts in doubles, as we do
  std::once_flag warmed_;
};

Session& session() {
  static Session only;
  return only;
}

std::atomic<int> initialised{0};  // by the program, which has not closed it as often yet

// ODE's own functions come here where they call each other, also those of a program that has found them by itself, of
// which we hear in no other way.
class NotTakenOver {
 public:
  NotTakenOver() = default;
  NotTakenOver(const NotTakenOver&) = delete;
  NotTakenOver& operator=(const NotTakenOver&) = delete;
  ~NotTakenOver() {
    if (!meshes_.load(std::memory_order_relaxed) || initialised_.load(std::memory_order_relaxed)) return;
    const char* const report = std::getenv("ODDS_REPORT");
    if (report != nullptr && std::string_view(report) == "off") return;
    std::fputs(
        "warning: libodds_preload: no takeover: the program looked up ODE's functions by itself (dlsym), or never "
        "initialised ODE\n",
        stderr);
  }
  void note_mesh() noexcept { meshes_.store(true, std::memory_order_relaxed); }
  void note_initialised() noexcept { initialised_.store(true, std::memory_order_relaxed); }

 private:
  std::atomic<bool> meshes_{false};
  std::atomic<bool> initialised_{false};
};
NotTakenOver not_taken_over;

// After every initialisation, so that a takeover outlives a real close of ODE.
void after_init() noexcept {
  if (inside) return;
  initialised.fetch_add(1, std::memory_order_relaxed);
  not_taken_over.note_initialised();
  const Inside guard;
  try {
    session().take_over();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "warning: libodds_preload: no takeover: %s\n", error.what());
  }
}

// ODE closes where the program closes it for the last time: held open by a takeover it would keep the program's classes
// of geoms, of which it has room for four, and abort where the program registers them anew.
void after_close() noexcept {
  if (inside || initialised.load(std::memory_order_relaxed) == 0) return;
  if (initialised.fetch_sub(1, std::memory_order_relaxed) > 1) return;
  const Inside guard;
  oddsGiveBackTriMesh();  // not of an ODE that hides its own colliders: there the takeover goes on
}

void before_mesh() noexcept {
  if (inside || ode::is_reading_trimesh() || oddsGetClass() < 0) return;
  const Inside guard;
  try {
    session().warm_up_once();
  } catch (const std::exception&) {  // no lock: the first collision is slow, that is all
  }
}

void after_mesh(dGeomID trimesh) noexcept {
  if (inside || ode::is_reading_trimesh() || trimesh == nullptr || dGeomTriMeshGetData(trimesh) == nullptr) return;
  const Inside guard;
  oddsForgetGeom(trimesh);
  oddsPrepareTriMesh(trimesh, nullptr);  // what cannot be prepared is left to ODE, and counted
}

void after_convex(dGeomID convex, const dReal* points, unsigned point_count, const unsigned* polygons,
                  unsigned face_count) noexcept {
  if (inside || convex == nullptr || oddsGetClass() < 0) return;
  const Inside guard;
  oddsForgetGeom(convex);
  oddsRegisterConvex(convex, points, point_count, polygons, face_count);
}

// Calls a function of ODE that changes the data of meshes: geoms of it are other meshes then.
template <class... Rest>
void change(void (*next)(dTriMeshDataID, Rest...), dTriMeshDataID data, Rest... rest) {
  next(data, rest...);
  not_taken_over.note_mesh();
  ode::note_changed(data);
}

}  // namespace
}  // namespace odds::preload

using odds::preload::real;

extern "C" {

void dInitODE(void) {
  static const auto next = real<void()>("dInitODE");
  {
    const odds::preload::Inside guard;  // it may call dInitODE2
    next();
  }
  odds::preload::after_init();
}

int dInitODE2(unsigned int flags) {
  static const auto next = real<int(unsigned)>("dInitODE2");
  const int result = next(flags);
  if (result != 0) odds::preload::after_init();
  return result;
}

void dCloseODE(void) {
  static const auto next = real<void()>("dCloseODE");
  next();
  odds::preload::after_close();
}

dGeomID dCreateTriMesh(dSpaceID space, dTriMeshDataID data, dTriCallback* callback, dTriArrayCallback* array_callback,
                       dTriRayCallback* ray_callback) {
  static const auto next = real<decltype(dCreateTriMesh)>("dCreateTriMesh");
  odds::preload::before_mesh();
  const dGeomID geom = next(space, data, callback, array_callback, ray_callback);
  odds::preload::after_mesh(geom);
  return geom;
}

void dGeomTriMeshSetData(dGeomID geom, dTriMeshDataID data) {
  static const auto next = real<decltype(dGeomTriMeshSetData)>("dGeomTriMeshSetData");
  next(geom, data);
  odds::preload::after_mesh(geom);
}

dGeomID dCreateConvex(dSpaceID space, const dReal* planes, unsigned int plane_count, const dReal* points,
                      unsigned int point_count, const unsigned int* polygons) {
  static const auto next = real<decltype(dCreateConvex)>("dCreateConvex");
  const dGeomID geom = next(space, planes, plane_count, points, point_count, polygons);
  odds::preload::after_convex(geom, points, point_count, polygons, plane_count);
  return geom;
}

void dGeomSetConvex(dGeomID geom, const dReal* planes, unsigned int plane_count, const dReal* points,
                    unsigned int point_count, const unsigned int* polygons) {
  static const auto next = real<decltype(dGeomSetConvex)>("dGeomSetConvex");
  next(geom, planes, plane_count, points, point_count, polygons);
  odds::preload::after_convex(geom, points, point_count, polygons, plane_count);
}

// A program calls it where it has moved vertices. What then answers is ODE's own collider, whose tree is refitted: ours
// would have to be built anew, inside the loop.
void dGeomTriMeshDataUpdate(dTriMeshDataID data) {
  static const auto next = real<decltype(dGeomTriMeshDataUpdate)>("dGeomTriMeshDataUpdate");
  odds::preload::change(next, data);
}

// The same of a program that builds data anew.
void dGeomTriMeshDataBuildSingle(dTriMeshDataID data, const void* vertices, int vertex_stride, int vertex_count,
                                 const void* indices, int index_count, int stride) {
  static const auto next = real<decltype(dGeomTriMeshDataBuildSingle)>("dGeomTriMeshDataBuildSingle");
  odds::preload::change(next, data, vertices, vertex_stride, vertex_count, indices, index_count, stride);
}

void dGeomTriMeshDataBuildSingle1(dTriMeshDataID data, const void* vertices, int vertex_stride, int vertex_count,
                                  const void* indices, int index_count, int stride, const void* normals) {
  static const auto next = real<decltype(dGeomTriMeshDataBuildSingle1)>("dGeomTriMeshDataBuildSingle1");
  odds::preload::change(next, data, vertices, vertex_stride, vertex_count, indices, index_count, stride, normals);
}

void dGeomTriMeshDataBuildDouble(dTriMeshDataID data, const void* vertices, int vertex_stride, int vertex_count,
                                 const void* indices, int index_count, int stride) {
  static const auto next = real<decltype(dGeomTriMeshDataBuildDouble)>("dGeomTriMeshDataBuildDouble");
  odds::preload::change(next, data, vertices, vertex_stride, vertex_count, indices, index_count, stride);
}

void dGeomTriMeshDataBuildDouble1(dTriMeshDataID data, const void* vertices, int vertex_stride, int vertex_count,
                                  const void* indices, int index_count, int stride, const void* normals) {
  static const auto next = real<decltype(dGeomTriMeshDataBuildDouble1)>("dGeomTriMeshDataBuildDouble1");
  odds::preload::change(next, data, vertices, vertex_stride, vertex_count, indices, index_count, stride, normals);
}

void dGeomTriMeshDataBuildSimple(dTriMeshDataID data, const dReal* vertices, int vertex_count, const dTriIndex* indices,
                                 int index_count) {
  static const auto next = real<decltype(dGeomTriMeshDataBuildSimple)>("dGeomTriMeshDataBuildSimple");
  odds::preload::change(next, data, vertices, vertex_count, indices, index_count);
}

void dGeomTriMeshDataBuildSimple1(dTriMeshDataID data, const dReal* vertices, int vertex_count,
                                  const dTriIndex* indices, int index_count, const int* normals) {
  static const auto next = real<decltype(dGeomTriMeshDataBuildSimple1)>("dGeomTriMeshDataBuildSimple1");
  odds::preload::change(next, data, vertices, vertex_count, indices, index_count, normals);
}

void dGeomTriMeshDataDestroy(dTriMeshDataID data) {
  static const auto next = real<decltype(dGeomTriMeshDataDestroy)>("dGeomTriMeshDataDestroy");
  odds::ode::note_destroyed(data);  // before another thread has data at its address
  next(data);
}

void dGeomDestroy(dGeomID geom) {
  static const auto next = real<decltype(dGeomDestroy)>("dGeomDestroy");
  if (geom != nullptr && !odds::preload::inside) {
    const odds::preload::Inside guard;
    oddsForgetGeom(geom);
  }
  next(geom);
}

}  // extern "C"
