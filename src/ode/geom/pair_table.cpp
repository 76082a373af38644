// Making, finding and freeing the workspaces of pairs.
#include "ode/geom/pair_table.hpp"

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "ode/geom/partners.hpp"
#include "ode/last_error.hpp"
#include "ode/pair_hash.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

// A short query in full overlap goes through the code and fills the hit list, or queue, as far as it goes: a
// millisecond or four, which a pair whose first query follows at once does better without.
void warm(query::Pair& pair) noexcept {
  query::Request request;
  request.budget = query::Budget::work(2000);
  request.max_contacts = 8;
  for (const query::Method method : {query::Method::time_critical, query::Method::incremental}) {
    request.method = method;
    static_cast<void>(pair.run(math::Pose(), request));
  }
  pair.reset();
}

std::unique_ptr<PairEntry> make_entry(GeomData& a, GeomData& b, bool warmed) {
  auto entry = std::make_unique<PairEntry>();
  entry->a = &a;
  entry->b = &b;
  auto pair = query::Pair::make(a.mesh->shape, b.mesh->shape, {.late_contacts = true});
  if (pair.ok()) {
    entry->pair.emplace(std::move(pair).value());
    if (warmed) warm(*entry->pair);
  } else {
    set_last_error(pair.error());
  }
  return entry;
}

// Collisions of a dGeomTransform arrive as collisions of the geom inside it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored \
    "-Wdeprecated-declarations"  // ODE advises offsets instead, but its users still have transforms
dGeomID inside_transforms(dGeomID geom) noexcept {
  while (geom != nullptr && dGeomGetClass(geom) == dGeomTransformClass) geom = dGeomTransformGetGeom(geom);
  return geom;
}
#pragma GCC diagnostic pop

// The mesh of one geom of a pair: its own, or one that stands in for it. A dTriMesh that is not known yet is read, with
// the bounding volume of the other. Null for a primitive, and with the last error set if a dTriMesh cannot be read.
GeomData* prepared_data(dGeomID geom, dGeomID other) noexcept {
  if (dGeomGetClass(geom) == oddsGetClass()) return &own_data(geom);
  if (Partner* known = partner_table().find(geom)) {
    if (known->convex != nullptr) return nullptr;
    if (known->mesh != nullptr && is_unchanged(*known)) return known->mesh.get();
  }
  if (dGeomGetClass(geom) != dTriMeshClass) return nullptr;
  oddsBuildParams params;
  oddsBuildParamsInit(&params);
  if (const GeomData* partner = known_data(other)) params.volume = static_cast<int>(partner->mesh->shape->volume());
  const Partner* adopted = adopt_trimesh(geom, &params, true);
  return adopted != nullptr ? adopted->mesh.get() : nullptr;
}

}  // namespace

// Never destroyed: see partner_table.
PairTable& pair_table() noexcept {
  static PairTable& only = *new PairTable;
  return only;
}

// Numbers count geoms: no process makes 2^32 of them.
std::uint64_t PairTable::key_of(const GeomData& a, const GeomData& b) noexcept {
  return mixed(a.number << 32U | (b.number & 0xffffffffU));
}

PairEntry* PairTable::find(const GeomData& x, const GeomData& y) const noexcept {
  return x.number < y.number ? entries_.find(key_of(x, y)) : entries_.find(key_of(y, x));
}

PairTable::Made PairTable::prepare(GeomData& x, GeomData& y, bool warmed) noexcept {
  try {
    const std::lock_guard lock(writers_);
    if (PairEntry* found = find(x, y)) {
      if (!found->pair)
        set_last_error(
            "the pair could not be prepared before; make one of its geoms anew, of data with the other's volume if "
            "they differ");
      return {found, false};
    }
    GeomData& a = x.number < y.number ? x : y;
    GeomData& b = x.number < y.number ? y : x;
    std::unique_ptr<PairEntry> entry = make_entry(a, b, warmed);
    const std::uint64_t key = key_of(a, b);
    entries_.reserve(key);
    for (GeomData* geom : {&a, &b}) {
      if (geom->pairs.size() == geom->pairs.capacity()) geom->pairs.reserve(2 * geom->pairs.size() + 4);
    }
    a.pairs.push_back(entry.get());
    b.pairs.push_back(entry.get());
    entries_.insert(key, entry.get());
    count(statistics().live_pairs);
    return {entry.release(), true};
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("preparing a pair failed");
  }
  return {};
}

const PairEntry* answered_pair(dGeomID g1, dGeomID g2) noexcept {
  const GeomData* x = known_data(g1);
  const GeomData* y = known_data(g2);
  if (x == nullptr || y == nullptr) return nullptr;
  const PairEntry* entry = pair_table().find(*x, *y);
  return entry != nullptr && entry->answered ? entry : nullptr;
}

void PairTable::forget(GeomData& geom) noexcept {
  try {
    const std::lock_guard lock(writers_);
    for (PairEntry* entry : geom.pairs) {
      entries_.remove(key_of(*entry->a, *entry->b));
      GeomData& other = entry->a == &geom ? *entry->b : *entry->a;
      if (&other != &geom) std::erase(other.pairs, entry);
      delete entry;
      statistics().live_pairs.fetch_sub(1, std::memory_order_relaxed);
    }
    geom.pairs.clear();
  } catch (...) {
    count(statistics().caught);
  }
}

}  // namespace odds::ode

int oddsPreparePair(dGeomID g1, dGeomID g2) noexcept {
  using namespace odds::ode;
  g1 = inside_transforms(g1);
  g2 = inside_transforms(g2);
  const int our_class = oddsGetClass();
  if (g1 == nullptr || g2 == nullptr || g1 == g2 || dGeomIsSpace(g1) != 0 || dGeomIsSpace(g2) != 0) {
    set_last_error(
        "oddsPreparePair: needs two different geoms, not null and not spaces; prepare the members of a space one by "
        "one");
    return 0;
  }
  const auto is_mesh = [our_class](dGeomID geom) {
    return our_class >= 0 && (dGeomGetClass(geom) == our_class || dGeomGetClass(geom) == dTriMeshClass);
  };
  if (!is_mesh(g1) && !is_mesh(g2)) {
    set_last_error(
        "oddsPreparePair: neither geom is a mesh made by dCreateOddsMesh or a dTriMesh (or the library is not "
        "initialised)");
    return 0;
  }
  GeomData* first = prepared_data(g1, g2);
  GeomData* second = first != nullptr || !is_mesh(g1) ? prepared_data(g2, g1) : nullptr;
  const bool failed = (is_mesh(g1) && first == nullptr) || (is_mesh(g2) && second == nullptr);
  if (failed) return 0;
  const auto is_unanswered = [our_class](dGeomID geom, const GeomData* data, dGeomID other) {
    return data == nullptr && dGeomGetClass(geom) == dHeightfieldClass && dGeomGetClass(other) == our_class;
  };
  if (is_unanswered(g1, first, g2) || is_unanswered(g2, second, g1)) {
    set_last_error(
        "oddsPreparePair: no mesh stands in for the heightfield, or not for the data that it has now; call "
        "oddsSetStandIn");
    return 0;
  }
  if (first == nullptr || second == nullptr) return 1;
  const PairTable::Made made = pair_table().prepare(*first, *second, true);
  return made.entry != nullptr && made.entry->pair ? 1 : 0;
}

int oddsGetLastAnswer(dGeomID g1, dGeomID g2, oddsAnswer* answer) noexcept {
  using namespace odds::ode;
  const GeomData* x = find_data(g1, "oddsGetLastAnswer");
  if (x == nullptr || find_data(g2, "oddsGetLastAnswer") == nullptr) return 0;
  if (answer == nullptr) {
    set_last_error("oddsGetLastAnswer: the place for the answer is null; give one");
    return 0;
  }
  const PairEntry* entry = answered_pair(g1, g2);
  if (entry == nullptr) {
    set_last_error("oddsGetLastAnswer: these two geoms never collided");
    return 0;
  }
  *answer = entry->last;
  if (entry->a != x) {
    for (double& component : answer->cell_normal) component = -component;
  }
  return 1;
}
