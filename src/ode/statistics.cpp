// oddsGetStats and oddsResetStats.
#include "ode/statistics.hpp"

#include "odds/ode/odds_ode.h"

namespace odds::ode {

Statistics& statistics() noexcept {
  static constinit Statistics all;
  return all;
}

}  // namespace odds::ode

void oddsGetStats(oddsStats* stats) noexcept {
  if (stats == nullptr) return;
  const odds::ode::Statistics& all = odds::ode::statistics();
  const auto read = [](const odds::ode::Counter& counter) { return counter.load(std::memory_order_relaxed); };
  stats->queries = read(all.queries);
  stats->queries_proved = read(all.queries_proved);
  stats->queries_estimated = read(all.queries_estimated);
  stats->queries_budget = read(all.queries_budget);
  stats->contacts = read(all.contacts);
  stats->cell_pair_contacts = read(all.cell_pair_contacts);
  stats->primitive_queries = read(all.primitive_queries);
  stats->primitive_cut_off = read(all.primitive_cut_off);
  stats->unsupported = read(all.unsupported);
  stats->lazy_pairs = read(all.lazy_pairs);
  stats->failed_pairs = read(all.failed_pairs);
  stats->busy_pairs = read(all.busy_pairs);
  stats->bad_poses = read(all.bad_poses);
  stats->caught = read(all.caught);
  stats->live_geoms = read(all.live_geoms);
  stats->live_pairs = read(all.live_pairs);
  stats->lazy_partners = read(all.lazy_partners);
  stats->changed_partners = read(all.changed_partners);
  stats->live_partners = read(all.live_partners);
  stats->taken_over = read(all.taken_over);
  stats->fallbacks = read(all.fallbacks);
}

void oddsResetStats(void) noexcept {
  odds::ode::Statistics& all = odds::ode::statistics();
  for (odds::ode::Counter* counter :
       {&all.queries, &all.queries_proved, &all.queries_estimated, &all.queries_budget, &all.contacts,
        &all.cell_pair_contacts, &all.primitive_queries, &all.primitive_cut_off, &all.unsupported, &all.lazy_pairs,
        &all.failed_pairs, &all.busy_pairs, &all.bad_poses, &all.caught, &all.lazy_partners, &all.changed_partners,
        &all.taken_over, &all.fallbacks}) {
    counter->store(0, std::memory_order_relaxed);
  }
}
