#include "query/pair/witness.hpp"

#include "query/contacts/pair_contacts.hpp"
#include "query/contacts/short_budget.hpp"

namespace odds::query {

bool witness_suffices(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                      Spending& spending) noexcept {
  if (wanted_hits(request, pair) != 1 || !pair.has_witness || !spending.allows(1)) return false;
  const auto still_meets = [&](const TrianglePair& tried) {
    spending.spend_triangle_pairs(1);
    if (!meshes.meet(tried)) return false;
    pair.hits.add(tried);
    return true;
  };
  if (still_meets(pair.witness)) return true;
  if (!is_short(request, pair)) return false;
  // Places that were guessed in the runs before: to search again would take what time there is for contacts.
  for (std::size_t i = 0; i < pair.haste.count(); ++i) {
    if (!spending.allows(1) || !spending.may_go_on_after(2)) return false;
    const TrianglePair guessed = pair.haste.pair_of(i);
    if (!still_meets(guessed)) continue;
    pair.witness = guessed;
    return true;
  }
  return false;
}

void remember_witness(Pair::Implementation& pair) noexcept {
  pair.has_witness = !pair.hits.empty();
  if (pair.has_witness) pair.witness = pair.hits.pairs().front();
}

}  // namespace odds::query
