// Our colliders behind ODE's table entries for dTriMesh; what they cannot answer is left to ODE's own.
#include "ode/geom/takeover.hpp"

#include <atomic>
#include <cstddef>
#include <string>

#include "odds/realtime/clock.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/geom/odes_colliders.hpp"
#include "ode/geom/pair_table.hpp"
#include "ode/geom/partners.hpp"
#include "ode/geom/registry.hpp"
#include "ode/last_error.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

constinit std::atomic<unsigned> taken{0};  // ODDS_TAKE_... bits, 0: off
constinit std::atomic<TakeoverObserver> watching{nullptr};

// A client that filters triangles, or wants to hear of them, hears of them from ODE's own colliders only.
bool has_callbacks(dGeomID trimesh) noexcept {
  return dGeomTriMeshGetCallback(trimesh) != nullptr || dGeomTriMeshGetArrayCallback(trimesh) != nullptr ||
         dGeomTriMeshGetRayCallback(trimesh) != nullptr || dGeomTriMeshGetTriMergeCallback(trimesh) != nullptr;
}

// The mesh of a dTriMesh that we may answer for, or null; one that is not known yet is read for what it meets.
GeomData* ours(dGeomID trimesh, dGeomID other) noexcept {
  if (has_callbacks(trimesh)) return nullptr;
  const GeomData* met = known_data(other);
  return mesh_of_partner(trimesh, met != nullptr ? met->mesh->shape->volume() : volume::Kind::wide);
}

bool can_answer(dGeomID o1, dGeomID o2) noexcept {
  const GeomData* first = ours(o1, o2);
  if (first == nullptr) return false;
  const int other = dGeomGetClass(o2);
  if (other == dTriMeshClass) {
    const GeomData* second = ours(o2, o1);
    if (second == nullptr || first->mesh->shape->volume() != second->mesh->shape->volume()) return false;
    const PairEntry* entry = pair_table().find(*first, *second);
    return entry == nullptr || entry->pair.has_value();  // else: no memory
  }
  if (other != dConvexClass) return true;
  Partner* const convex = partner_table().find(o2);
  if (convex == nullptr || convex->convex == nullptr) return false;
  if (is_unchanged(*convex)) return true;
  count(statistics().changed_partners);
  return false;
}

dColliderFn* our_collider(int other) noexcept { return other == dTriMeshClass ? &collide_mesh : collider_for(other); }

int answer(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip, bool& by_ode) noexcept {
  by_ode = !can_answer(o1, o2);
  if (by_ode) {
    count(statistics().fallbacks);
    return collide_by_ode(o1, o2, flags, contacts, skip);
  }
  count(statistics().taken_over);
  return our_collider(dGeomGetClass(o2))(o1, o2, flags, contacts, skip);
}

// In ODE's table; o1 is a dTriMesh.
int collide_taken(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  const TakeoverObserver observer = watching.load(std::memory_order_relaxed);
  bool by_ode = false;
  if (observer == nullptr) return answer(o1, o2, flags, contacts, skip, by_ode);
  const realtime::Clock clock = realtime::fastest_clock();
  const std::int64_t start = clock();
  const int found = answer(o1, o2, flags, contacts, skip, by_ode);
  observer(dGeomGetClass(o2), clock() - start, found, by_ode);
  return found;
}

// Puts ODE's own colliders back for these bits, or says why not.
bool restore(unsigned bits, const char* caller) noexcept {
  for (std::size_t i = 0; i < takeover_classes.size(); ++i) {
    if ((bits >> i & 1u) == 0 || has_odes_collider(takeover_classes[i])) continue;
    try {
      set_last_error(std::string(caller) +
                     ": this build of ODE hides its own colliders; close it and initialise it anew");
    } catch (...) {
      set_last_error("this build of ODE hides its own colliders");
    }
    return false;
  }
  for (std::size_t i = 0; i < takeover_classes.size(); ++i) {
    if ((bits >> i & 1u) != 0) restore_odes_collider(takeover_classes[i]);
  }
  return true;
}

bool is_valid(const oddsTakeOverParams& params) noexcept {
  return params.partners != 0 && params.partners <= ODDS_TAKE_ALL && params.budget_us > 0.0 &&
         params.max_contacts >= 0 && params.max_contacts <= 8;
}

}  // namespace

void observe_takeover(TakeoverObserver observer) noexcept { watching.store(observer, std::memory_order_relaxed); }

void install_takeover() noexcept {
  const unsigned bits = taken.load(std::memory_order_relaxed);
  for (std::size_t i = 0; i < takeover_classes.size(); ++i) {
    if ((bits >> i & 1u) != 0) dSetColliderOverride(dTriMeshClass, takeover_classes[i], &collide_taken);
  }
}

}  // namespace odds::ode

void oddsTakeOverParamsInit(oddsTakeOverParams* params) noexcept {
  if (params == nullptr) return;
  const odds::ode::Settings defaults;
  params->partners = ODDS_TAKE_ALL;
  params->budget_us = defaults.budget_us;
  params->work_units = 0;
  params->max_contacts = defaults.max_contacts;
}

int oddsTakeOverTriMesh(const oddsTakeOverParams* params) noexcept {
  using namespace odds::ode;
  oddsTakeOverParams defaults;
  oddsTakeOverParamsInit(&defaults);
  const oddsTakeOverParams& used = params != nullptr ? *params : defaults;
  if (!is_valid(used)) {
    set_last_error(
        "oddsTakeOverTriMesh: no partners, a budget not > 0, or contacts not 0 .. 8; see oddsTakeOverParams");
    return 0;
  }
  const unsigned before = taken.load(std::memory_order_relaxed);
  if ((before & ~used.partners) != 0 && !restore(before & ~used.partners, "oddsTakeOverTriMesh")) return 0;
  if (before == 0 ? oddsInitODE(0) == 0 : !hold_again()) return 0;
  Settings settings;
  settings.budget_us = used.budget_us;
  settings.work_units = used.work_units;
  settings.max_contacts = used.max_contacts;
  partner_settings() = settings;
  taken.store(used.partners, std::memory_order_relaxed);
  install_takeover();
  return 1;
}

int oddsGiveBackTriMesh(void) noexcept {
  using namespace odds::ode;
  const unsigned bits = taken.load(std::memory_order_relaxed);
  if (bits == 0) {
    set_last_error("oddsGiveBackTriMesh: nothing was taken over");
    return 0;
  }
  if (!restore(bits, "oddsGiveBackTriMesh")) return 0;
  taken.store(0, std::memory_order_relaxed);
  partner_settings() = neutral_settings();
  oddsCloseODE();
  return 1;
}
