// Contacts of surfaces that have come apart by no more than a margin.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "odds/query/contact_patch.hpp"
#include "odds/query/held_contact.hpp"
#include "odds/query/pair.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Where a pair's surfaces touched in its last run, or were still near. No allocation.
class NearContacts {
 public:
  void forget() noexcept { count_ = 0; }
  void keep(std::span<const Contact> contacts, const math::Pose& pose_b_in_a) noexcept {
    count_ = std::min(contacts.size(), held_.size());
    for (std::size_t i = 0; i < count_; ++i) held_[i] = HeldContact(contacts[i], pose_b_in_a);
  }
  [[nodiscard]] std::span<const HeldContact> last() const noexcept { return std::span(held_).first(count_); }

 private:
  std::array<HeldContact, most_contacts> held_;
  std::size_t count_ = 0;
};

/// Adds to the contacts of an answer, behind them, those that touched in the last run, have come apart, and where rays
/// along the normal of then see the surfaces within `request.margin` of each other. For what time is left. See
/// Request::margin.
void add_near_contacts(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                       Spending& spending) noexcept;

}  // namespace odds::query
