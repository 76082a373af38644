// Names in memory that is always there: a handler of a signal may neither allocate nor wait.
#include "mesh/unfinished_file.hpp"

#include <limits.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

namespace odds::mesh {
namespace {

enum class Use : int { none, being_named, named };

struct Slot {
  std::atomic<Use> use{Use::none};
  std::array<char, PATH_MAX> path;
};
static_assert(std::atomic<Use>::is_always_lock_free);

std::array<Slot, UnfinishedFile::most> slots;

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) noexcept {
  if (path.size() >= PATH_MAX) return;
  for (std::size_t i = 0; i < most; ++i) {
    Use expected = Use::none;
    if (!slots[i].use.compare_exchange_strong(expected, Use::being_named)) continue;
    std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
    slots[i].use = Use::named;
    slot_ = i;
    return;
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (slot_ != most) slots[slot_].use = Use::none;
}

UnfinishedFile::UnfinishedFile(UnfinishedFile&& other) noexcept : slot_(std::exchange(other.slot_, most)) {}

void remove_unfinished_files() noexcept {
  const int before = errno;
  for (const Slot& slot : slots) {
    if (slot.use == Use::named) (void)unlink(slot.path.data());
  }
  errno = before;
}

}  // namespace odds::mesh
