// What of a budget is kept for what follows the search, and how that changes under way.
#include "query/spending.hpp"

#include <algorithm>

namespace odds::query {

void Spending::keep_time_for_contacts() noexcept {
  if (!timed_) return;
  const auto share_ns = static_cast<std::int64_t>((allowance_ns() < short_ns ? short_search_share : search_share) *
                                                  static_cast<double>(allowance_ns()));
  last_moment_ns_ = std::min(last_moment_ns_, deadline_ns_ - kept_ns(kept_.contacts_ns));
  search_deadline_ns_ = std::min({search_deadline_ns_, start_ns_ + share_ns, last_moment_ns_});
}

std::int64_t Spending::search_kept_ns(bool cold) const noexcept {
  const std::int64_t most_ns = kept_.pieces_are_long
                                   ? std::max(std::min(long_piece_ns, allowance_ns()), allowance_ns() * 6 / 10)
                                   : std::max(most_kept_ns(), std::min(cold_ending_ns, allowance_ns() * 45 / 100));
  return std::max(std::min((cold ? 2 : 1) * kept_.search_ns, most_ns), kept_ns(kept_.last_contact_ns, cold));
}

void Spending::end_earlier() noexcept {
  const std::int64_t search_earlier_ns = search_kept_ns(true) - search_kept_ns(false);
  search_deadline_ns_ -= search_earlier_ns;
  if (contacts_ended_) return;
  const std::int64_t earlier_ns = contacts_reserve_ != nullptr
                                      ? kept_ns(contacts_reserve_->ns(), true) - kept_ns(contacts_reserve_->ns(), false)
                                      : search_earlier_ns;
  last_moment_ns_ -= earlier_ns;
  contacts_deadline_ns_ -= earlier_ns;
}

}  // namespace odds::query
