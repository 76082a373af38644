// What of a budget is kept for what follows the search, and how that changes under way.
#include "query/spending.hpp"

#include <algorithm>

namespace odds::query {

void Spending::keep_time_for_contacts() noexcept {
  if (!timed_) return;
  contacts_wait_ = true;
  patience_ = 0;
  const auto share_ns = static_cast<std::int64_t>((allowance_ns() < short_ns ? short_search_share : search_share) *
                                                  static_cast<double>(allowance_ns()));
  last_moment_ns_ = std::min(last_moment_ns_, deadline_ns_ - kept_ns(kept_.contacts_ns));
  search_deadline_ns_ = std::min({search_deadline_ns_, start_ns_ + share_ns, last_moment_ns_});
}

// Of poses that nothing led to the last piece and the answer take 0.8 us, one in a hundred 1.6, for caches know
// nothing of them; on slower processors half as long again, which a pair learns. What is kept beyond that would leave
// too little of 2 us to search in.
std::int64_t Spending::most_search_ending_ns() const noexcept {
  constexpr std::int64_t long_piece_ns = 1'000;
  constexpr std::int64_t unforeseen_ns = 2'000;
  const std::int64_t ns = allowance_ns();
  return kept_.pieces_are_long ? std::max(std::min(long_piece_ns, ns), ns * 6 / 10)
                               : std::max(most_ending_ns(), std::min(unforeseen_ns, ns * 6 / 10));
}

std::int64_t Spending::search_kept_ns(bool cold) const noexcept {
  return std::max(kept_ns(kept_.search_ns, most_search_ending_ns(), cold),
                  kept_ns(kept_.last_contact_ns, most_ending_ns(), cold));
}

void Spending::end_earlier() noexcept {
  patience_ = 0;
  spare_looks_ = 0;
  const std::int64_t search_earlier_ns = search_kept_ns(true) - search_kept_ns(false);
  search_deadline_ns_ -= search_earlier_ns;
  if (contacts_ended_) return;
  const std::int64_t earlier_ns = contacts_reserve_ != nullptr ? more_when_cold_ns(contacts_reserve_->ns())
                                  : contacts_wait_             ? more_when_cold_ns(kept_.contacts_ns)
                                                               : search_earlier_ns;
  last_moment_ns_ -= earlier_ns;
  contacts_deadline_ns_ -= earlier_ns;
}

}  // namespace odds::query
