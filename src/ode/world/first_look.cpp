#include "ode/world/first_look.hpp"

#include <array>

#include "ode/world/world_options.hpp"

namespace odds::ode {
namespace {

// Geoms accept a change of budget, as they accepted the settings that they have.
void configure_all(dSpaceID space, const query::Request& query) noexcept {
  for (int i = 0; i < dSpaceGetNumGeoms(space); ++i) static_cast<void>(configure(dSpaceGetGeom(space, i), query));
}

void look(void*, dGeomID a, dGeomID b) noexcept {
  std::array<dContactGeom, most_contacts_per_pair> found;
  dCollide(a, b, most_contacts_per_pair, found.data(), sizeof(dContactGeom));
}

}  // namespace

void first_look(dSpaceID space, const query::Request& query) noexcept {
  query::Request unlimited = query;
  unlimited.budget = query::Budget::unlimited();
  unlimited.p_min = 1.0;
  configure_all(space, unlimited);
  dSpaceCollide(space, nullptr, &look);
  configure_all(space, query);
}

}  // namespace odds::ode
