// A torus knot falls on hills, both triangle meshes, through dSpaceCollide with 100 microseconds per collision.
#include <odds/mesh/made/by_name.hpp>
#include <odds/ode/geom.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

template <class T>
T value_or_exit(odds::Result<T> result) {
  if (result) return std::move(result).value();
  std::fprintf(stderr, "error: %s\n", result.error().message().c_str());
  std::exit(1);
}

std::shared_ptr<const odds::query::Shape> shape(const char* mesh) {
  return value_or_exit(odds::query::Shape::build(
      std::make_shared<const odds::mesh::TriangleMesh>(value_or_exit(odds::mesh::made::make_shape(mesh)))));
}

struct World {
  dWorldID id = dWorldCreate();
  dSpaceID space = dSimpleSpaceCreate(nullptr);  // a hash space would allocate in every step
  dJointGroupID contacts = dJointGroupCreate(0);
  ~World() {
    dJointGroupDestroy(contacts);
    dSpaceDestroy(space);
    dWorldDestroy(id);
  }
};

// Ordinary ODE: nothing here knows about odds.
void collide(void* data, dGeomID a, dGeomID b) {
  auto* world = static_cast<World*>(data);
  dContact contacts[8] = {};
  const int count = dCollide(a, b, 8, &contacts[0].geom, sizeof(dContact));
  for (int i = 0; i < count; ++i) {
    contacts[i].surface.mu = 0.7;
    const dJointID joint = dJointCreateContact(world->id, world->contacts, &contacts[i]);
    dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
  }
}

}  // namespace

int main() {
  using namespace odds;
  const ode::Library library = value_or_exit(ode::Library::open());  // instead of dInitODE; outlives every geom
  World world;
  dWorldSetGravity(world.id, 0, 0, -9.81);
  dWorldSetContactMaxCorrectingVel(world.id, 0.5);
  dWorldSetLinearDamping(world.id, 1e-3);
  dWorldSetAngularDamping(world.id, 5e-3);

  // A solid, not a sheet: of a closed mesh the orientation says for sure where out is.
  // Destroyed before the space, so that the space does not destroy them too.
  ode::Geom hills = value_or_exit(ode::Geom::make(world.space, shape("made:terrain:depth=0.3")));
  ode::Geom knot = value_or_exit(ode::Geom::make(world.space, shape("made:torus_knot")));
  const dBodyID body = dBodyCreate(world.id);
  dMass mass;
  dMassSetSphereTotal(&mass, 0.2, 0.05);  // kg, m
  dBodySetMass(body, &mass);
  dGeomSetBody(knot.id(), body);
  dBodySetPosition(body, 0.1, 0.05, 0.4);

  dGeomOddsMeshSetBudget(knot.id(), 100);  // microseconds; the smaller budget of a pair holds
  // A free body forgives a step without contact better than a guessed one.
  dGeomOddsMeshSetUndecidedPolicy(knot.id(), ODDS_UNDECIDED_NO_CONTACT, 0.5);
  if (oddsPreparePair(hills.id(), knot.id()) == 0) {
    std::fprintf(stderr, "error: %s\n", oddsGetLastError());
    return 1;
  }

  constexpr const char* verdicts[] = {"clear", "hit"};
  constexpr const char* bases[] = {"proved", "estimated", "budget"};
  std::vector<double> net_us;
  std::printf("%6s %9s %9s  %-6s %-9s %8s %9s %11s %9s\n", "t / s", "z / m", "v / m/s", "", "", "P(hit)", "contacts",
              "node pairs", "us");
  for (int step = 0; step <= 3000; ++step) {
    dSpaceCollide(world.space, &world, &collide);
    dWorldQuickStep(world.id, 0.001);
    dJointGroupEmpty(world.contacts);
    oddsAnswer answer;
    if (oddsGetLastAnswer(knot.id(), hills.id(), &answer) == 0) continue;  // their boxes have not met yet
    net_us.push_back(answer.gross_us - answer.stall_us);
    if (step % 250 != 0) continue;
    const dReal* v = dBodyGetLinearVel(body);
    std::printf("%6.2f %9.4f %9.4f  %-6s %-9s %8.3f %9d %11llu %9.1f\n", step * 1e-3, dBodyGetPosition(body)[2],
                Vec3(v[0], v[1], v[2]).norm(), verdicts[answer.verdict], bases[answer.basis], answer.probability,
                answer.contacts, answer.node_pairs, net_us.back());
  }

  oddsStats stats;
  oddsGetStats(&stats);
  std::sort(net_us.begin(), net_us.end());
  const auto share = [&net_us](double q) {
    return net_us[static_cast<std::size_t>(q * static_cast<double>(net_us.size() - 1))];
  };
  std::printf("%llu collisions: %llu proved, %llu ended by the budget\n", stats.queries, stats.queries_proved,
              stats.queries_budget);
  std::printf("own time (without pre-emption): median %.1f us, p99 %.1f us, p99.9 %.1f us\n", share(0.5), share(0.99),
              share(0.999));
  const dReal* p = dBodyGetPosition(body);
  return p[2] > -0.2 && p[2] < 0.3 ? 0 : 1;  // it lies on the hills, and did not fall through: it also runs as a test
}
