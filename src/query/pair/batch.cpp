#include "odds/query/batch.hpp"

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>

#include "odds/tree/for_parts.hpp"

namespace odds::query {
namespace {

/// Poses that a thread takes at a time: some microseconds each, a thousand times what taking them costs.
constexpr std::size_t taken_at_once = 64;
constexpr std::size_t most_threads = 1024;

void answer_one(Pair& pair, const math::Pose& pose, const Request& request, BatchAnswer& to,
                std::span<Contact> contacts) noexcept {
  pair.reset();
  const Answer& answer = pair.run(pose, request);
  to = {.verdict = answer.verdict,
        .basis = answer.basis,
        .probability = answer.probability,
        .contacts = static_cast<std::uint32_t>(answer.contacts.size()),
        .contacts_complete = answer.contacts_complete,
        .cost = answer.cost};
  std::copy_n(answer.contacts.begin(), std::min(answer.contacts.size(), contacts.size()), contacts.begin());
}

}  // namespace

Result<Batch> Batch::make(std::shared_ptr<const Shape> a, std::shared_ptr<const Shape> b, const PairOptions& options,
                          std::size_t threads) {
  if (threads > most_threads) {
    return Error{"", "", "threads is " + std::to_string(threads), "choose 0 to " + std::to_string(most_threads)};
  }
  const std::size_t wanted = threads > 0 ? threads : tree::threads_for(most_threads);
  std::vector<Pair> pairs;
  pairs.reserve(wanted);
  while (pairs.size() < wanted) {
    Result<Pair> pair = Pair::make(a, b, options);
    if (!pair.ok()) return pair.error();
    pairs.push_back(std::move(pair).value());
  }
  return Batch(std::move(pairs));
}

std::optional<Error> Batch::run(std::span<const math::Pose> poses_b_in_a, const Request& request,
                                std::span<BatchAnswer> answers, std::span<Contact> contacts) {
  const std::size_t count = poses_b_in_a.size();
  if (answers.size() != count) {
    return Error{"", "", std::to_string(answers.size()) + " answers for " + std::to_string(count) + " poses",
                 "give an answer for each pose"};
  }
  const auto each = static_cast<std::size_t>(std::max(request.max_contacts, 0));
  // Not multiplied: more than there can be would wrap.
  const bool fits = each == 0 || (contacts.size() % each == 0 && contacts.size() / each == count);
  if (!contacts.empty() && !fits) {
    return Error{"", "",
                 std::to_string(contacts.size()) + " contacts for " + std::to_string(count) + " poses of " +
                     std::to_string(each),
                 "give Request::max_contacts for each pose, or none"};
  }
  Request alone = request;
  if (alone.method == Method::incremental) alone.method = Method::exact;
  const std::size_t wanted_contacts = contacts.empty() ? 0 : each;
  std::atomic<std::size_t> next_pair{0};
  std::atomic<std::size_t> next_pose{0};
  const std::size_t threads =
      std::min(pairs_.size(), std::max<std::size_t>(1, (count + taken_at_once - 1) / taken_at_once));
  tree::on_threads(threads, [&] {
    Pair& pair = pairs_[next_pair++];
    for (std::size_t first = next_pose.fetch_add(taken_at_once); first < count;
         first = next_pose.fetch_add(taken_at_once)) {
      const std::size_t end = std::min(count, first + taken_at_once);
      for (std::size_t i = first; i < end; ++i) {
        answer_one(pair, poses_b_in_a[i], alone, answers[i], contacts.subspan(i * wanted_contacts, wanted_contacts));
      }
    }
  });
  return std::nullopt;
}

}  // namespace odds::query
