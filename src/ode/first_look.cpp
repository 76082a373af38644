#include "ode/first_look.hpp"

#include <array>

#include "odds/ode/odds_ode.h"
#include "ode/world_options.hpp"

namespace odds::ode {
namespace {

bool configure_all(dSpaceID space, const query::Request& query) noexcept {
  bool done = true;
  for (int i = 0; i < dSpaceGetNumGeoms(space); ++i) done = configure(dSpaceGetGeom(space, i), query) && done;
  return done;
}

void look(void*, dGeomID a, dGeomID b) noexcept {
  std::array<dContactGeom, most_contacts_per_pair> found;
  dCollide(a, b, most_contacts_per_pair, found.data(), sizeof(dContactGeom));
}

}  // namespace

std::optional<Error> first_look(dSpaceID space, const query::Request& query) {
  query::Request unlimited = query;
  unlimited.budget = query::Budget::unlimited();
  const bool looked = configure_all(space, unlimited);
  if (looked) dSpaceCollide(space, nullptr, &look);
  if (configure_all(space, query) && looked) return std::nullopt;
  return Error{"", "", oddsGetLastError(), "correct the query's settings"};
}

}  // namespace odds::ode
