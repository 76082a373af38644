// odds_bench_partners: how long boxes, cylinders, capsules, balls and convexes on a mesh take within budgets of
// microseconds, and how many of them have contacts. Poses are about vertices of the mesh, turned anyhow, the same for
// every budget. Planes let the mesh sink in by up to 1 % of its size, rays go through its vertices. Times are net of
// the machine's stalls: of gaps between two looks at the clock, unless the same pose, as little of it in the caches,
// has one again. Shorter stalls than such gaps stay in; how many the machine has, the first rows tell: they do nothing
// but look at the clock until the budget is over. What stalls cannot explain is counted as late: poses that took over a
// microsecond more than the budget in each of four tries, with nothing taken away.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/ode/geom.hpp"
#include "odds/ode/odds_ode.h"
#include "odds/query/shape.hpp"
#include "odds/realtime/clock.hpp"
#include "odds/realtime/stall_ledger.hpp"
#include "ode/budget_clock.hpp"
#include "ode/known_convexes.hpp"
#include "support/cache_emptier.hpp"

namespace {

using odds::Vec3;

/// Puts a body somewhere about a vertex of the mesh; `size`: of bodies, metres.
using Put = void (*)(dGeomID body, const odds::mesh::TriangleMesh& mesh, const Vec3& vertex, double size,
                     odds::math::Random& random);

void put_turned(dGeomID body, const odds::mesh::TriangleMesh&, const Vec3& vertex, double size,
                odds::math::Random& random) {
  const Vec3 away = random.direction();
  const Vec3 place = vertex + random.uniform(0.0, 0.5) * size * away;
  const odds::Quat turn = random.rotation();
  const dQuaternion q = {turn.w(), turn.x(), turn.y(), turn.z()};
  dGeomSetPosition(body, place.x(), place.y(), place.z());
  dGeomSetQuaternion(body, q);
}

void put_plane(dGeomID plane, const odds::mesh::TriangleMesh& mesh, const Vec3&, double, odds::math::Random& random) {
  const Vec3 normal = random.direction();
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : mesh.vertices()) lowest = std::min(lowest, normal.dot(vertex));
  dGeomPlaneSetParams(plane, normal.x(), normal.y(), normal.z(), lowest + 0.01 * random.uniform() * mesh.size());
}

void put_ray(dGeomID ray, const odds::mesh::TriangleMesh&, const Vec3& vertex, double size,
             odds::math::Random& random) {
  const Vec3 direction = random.direction();
  const Vec3 from = vertex - 2.0 * size * direction;
  dGeomRaySet(ray, from.x(), from.y(), from.z(), direction.x(), direction.y(), direction.z());
}

struct Body {
  const char* name;
  dGeomID geom;
  Put put;
};

/// The clock of budgets, which notes when it is looked at.
class NotedClock {
 public:
  [[nodiscard]] odds::realtime::Clock clock() noexcept { return {&NotedClock::read, this}; }
  /// Steps of long collisions are longer.
  void set_budget(double us) noexcept {
    constexpr double longest_step = 0.15;  // of the budget
    const double ns = 1e3 * longest_step * us;
    longest_gap_ns_ = static_cast<std::int64_t>(std::clamp(ns, shortest_stall_ns, longest_step_ns));
  }
  void begin() noexcept { ledger_ = odds::realtime::StallLedger(exact_(), longest_gap_ns_); }
  /// Until now.
  const odds::realtime::StallLedger& end() noexcept {
    ledger_.poll(exact_());
    return ledger_;
  }

 private:
  static std::int64_t read(void* state) noexcept {
    auto* self = static_cast<NotedClock*>(state);
    const std::int64_t now = self->quick_();
    self->ledger_.poll(now);
    return now;
  }

  odds::realtime::Clock exact_ = odds::realtime::fastest_clock();
  odds::realtime::Clock quick_ = odds::realtime::without_waiting(exact_);
  static constexpr double shortest_stall_ns = 3e3;
  static constexpr double longest_step_ns = 20e3;
  std::int64_t longest_gap_ns_ = 0;
  odds::realtime::StallLedger ledger_{0};
};

NotedClock& noted_clock() {
  static NotedClock clock;
  return clock;
}

struct Measured {
  std::vector<double> us;  // sorted
  int stalled = 0;
  int late = 0;
  int hits = 0;
  int contacts = 0;

  [[nodiscard]] double at(double share) const {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  }
};

void print_row(const char* name, double budget_us, const Measured& m) {
  std::printf("%-10s %10.0f %8.1f %8.1f %8.1f %8.1f %8d %6d %8d %10d\n", name, budget_us, m.at(0.5), m.at(0.9),
              m.at(0.99), m.at(0.999), m.stalled, m.late, m.hits, m.contacts);
}

/// Whether what took `gross_ns` takes over a microsecond more than the budget whenever it is tried. `again()` gives the
/// nanoseconds of another try.
template <class Again>
bool is_late_again(double budget_us, std::int64_t gross_ns, const Again& again) {
  const auto is_late = [=](std::int64_t ns) { return 1e-3 * static_cast<double>(ns) > budget_us + 1.0; };
  return is_late(gross_ns) && is_late(again()) && is_late(again()) && is_late(again());
}

/// What any collision within that budget would show on this machine that could end at once.
Measured measure_clock(double budget_us, int times) {
  NotedClock& clock = noted_clock();
  const odds::realtime::Clock looks = clock.clock();
  Measured measured;
  const auto wait = [&] {
    clock.begin();
    const std::int64_t end = looks() + static_cast<std::int64_t>(1e3 * budget_us);
    while (looks() < end) {
    }
    return clock.end();
  };
  for (int i = 0; i < times; ++i) {
    const odds::realtime::StallLedger ledger = wait();
    measured.us.push_back(1e-3 * static_cast<double>(ledger.net_ns()));
    measured.stalled += ledger.stalls() > 0 ? 1 : 0;
    measured.late += is_late_again(budget_us, ledger.gross_ns(), [&] { return wait().gross_ns(); }) ? 1 : 0;
  }
  std::sort(measured.us.begin(), measured.us.end());
  return measured;
}

Measured measure(dGeomID mesh, const Body& body, const odds::mesh::TriangleMesh& shape, double size, double budget_us,
                 int poses, std::uint64_t seed) {
  NotedClock& clock = noted_clock();
  odds::testing::CacheEmptier emptier;
  Measured measured;
  for (int i = 0; i < poses; ++i) {
    odds::math::Random random(seed, static_cast<std::uint64_t>(i));
    const Vec3 vertex = shape.vertices()[random.below(shape.vertices().size())];
    body.put(body.geom, shape, vertex, size, random);
    dReal bounds[6];
    dGeomGetAABB(body.geom, bounds);  // a space has asked for them before
    std::array<dContactGeom, 8> contacts;
    const auto collide = [&] {
      clock.begin();
      const int found = dCollide(mesh, body.geom, 8, contacts.data(), sizeof contacts[0]);
      return std::pair(clock.end(), found);
    };
    const auto [ledger, count] = collide();
    const bool stalled = ledger.stalls() > 0;
    const auto again = [&] {
      emptier.run();  // as other poses do
      return collide().first;
    };
    const std::int64_t again_ns = stalled ? std::max(again().longest_gap_ns(), again().longest_gap_ns()) : 0;
    // Of one that comes again, if half as long, the machine's is what it is much longer by.
    const std::int64_t longest_ns = ledger.longest_gap_ns();
    const std::int64_t own_ns = 2 * again_ns >= longest_ns ? std::min(longest_ns, again_ns + again_ns / 2) : 0;
    measured.us.push_back(1e-3 * static_cast<double>(ledger.net_ns() + own_ns));
    measured.stalled += stalled && own_ns < longest_ns ? 1 : 0;
    measured.late += is_late_again(budget_us, ledger.gross_ns(), [&] { return again().gross_ns(); }) ? 1 : 0;
    measured.hits += count > 0 ? 1 : 0;
    measured.contacts += count;
  }
  std::sort(measured.us.begin(), measured.us.end());
  return measured;
}

int run(std::string_view name, int poses, std::uint64_t seed) {
  odds::ode::use_budget_clock(noted_clock().clock());
  auto mesh = odds::mesh::made::make_shape(name);
  auto library = odds::ode::Library::open();
  if (!mesh.ok() || !library.ok()) {
    std::fprintf(stderr, "%s\n", mesh.ok() ? library.error().message().c_str() : mesh.error().message().c_str());
    return 1;
  }
  const auto shared = std::make_shared<const odds::mesh::TriangleMesh>(std::move(mesh).value());
  const auto geom = odds::ode::Geom::make(nullptr, odds::query::Shape::build(shared).value()).value();
  const double size = 0.5 * shared->size();
  dGeomOddsMeshSetCarryMotion(geom.id(), 0);  // every pose stands alone
  std::printf("%s, %zu triangles, %d poses each; bodies of half its size\n", shared->name().c_str(),
              shared->triangles().size(), poses);
  std::printf("%-10s %10s %8s %8s %8s %8s %8s %6s %8s %10s\n", "body", "budget us", "p50", "p90", "p99", "p99.9",
              "stalled", "late", "hits", "contacts");
  const odds::test::ConvexBall convex(nullptr, 0.5 * size, 20, 12);
  const Body bodies[] = {{"box", dCreateBox(nullptr, size, size, size), put_turned},
                         {"cylinder", dCreateCylinder(nullptr, 0.5 * size, size), put_turned},
                         {"capsule", dCreateCapsule(nullptr, 0.25 * size, 0.5 * size), put_turned},
                         {"sphere", dCreateSphere(nullptr, 0.5 * size), put_turned},
                         {"convex", convex.geom, put_turned},
                         {"plane", dCreatePlane(nullptr, 0, 0, 1, 0), put_plane},
                         {"ray", dCreateRay(nullptr, 4.0 * size), put_ray}};
  constexpr double budgets_us[] = {5.0, 10.0, 20.0, 50.0, 100.0};
  for (const double us : budgets_us) {
    noted_clock().set_budget(us);
    print_row("(clock)", us, measure_clock(us, poses));
  }
  const auto collide_within = [&](const Body& body, double us) {
    dGeomOddsMeshSetBudget(geom.id(), std::min(us, 1e12));
    noted_clock().set_budget(us);
    print_row(body.name, us, measure(geom.id(), body, *shared, size, us, poses, seed));
  };
  for (const Body& body : bodies) {
    for (const double us : budgets_us) collide_within(body, us);
    collide_within(body, std::numeric_limits<double>::infinity());
    if (body.geom != convex.geom) dGeomDestroy(body.geom);
  }
  return 0;
}

bool number(std::string_view text, int& to) {
  return std::from_chars(text.data(), text.data() + text.size(), to).ec == std::errc();
}

}  // namespace

int main(int argc, char** argv) {
  int poses = 3000;
  int seed = 3;
  std::string_view name = "made:torus_knot:along=600,across=50";
  if (argc > 1) name = argv[1];
  if (argc > 4 || (argc > 2 && (!number(argv[2], poses) || poses < 100)) || (argc > 3 && !number(argv[3], seed))) {
    std::fprintf(stderr, "usage: odds_bench_partners [made:NAME... [POSES, >= 100 [SEED]]]\n");
    return 2;
  }
  return run(name, poses, static_cast<std::uint64_t>(seed));
}
