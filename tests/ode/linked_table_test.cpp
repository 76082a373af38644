// Tables that are read without a lock while another thread takes things out.
#include "ode/geom/linked_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <set>
#include <thread>

namespace odds::ode {
namespace {

using Table = LinkedTable<int, 4>;

void put(Table& table, std::uint64_t key, int& value) {
  table.reserve(key);
  table.insert(key, &value);
}

TEST(LinkedTable, FindsWhatIsThere) {
  Table table;
  std::array<int, 40> values{};
  for (std::uint64_t key = 1; key <= values.size(); ++key) put(table, key, values[key - 1]);
  EXPECT_EQ(table.find(41), nullptr);
  EXPECT_EQ(table.remove(41), nullptr);
  for (std::uint64_t key = 1; key <= values.size(); key += 2) EXPECT_EQ(table.remove(key), &values[key - 1]);
  for (std::uint64_t key = 1; key <= values.size(); ++key) {
    EXPECT_EQ(table.find(key), key % 2 == 0 ? &values[key - 1] : nullptr) << key;
  }
  for (std::uint64_t key = 1; key <= values.size(); key += 2) put(table, key + 100, values[key - 1]);
  std::set<int*> all;
  table.remove_all([&all](int* value) { all.insert(value); });
  EXPECT_EQ(all.size(), values.size());
  EXPECT_EQ(table.find(2), nullptr);
  put(table, 2, values[0]);
  EXPECT_EQ(table.find(2), &values[0]);
}

// A link that was freed under a reader of its chain was read all the same, whatever had been written there since.
TEST(LinkedTable, OthersComeAndGoUnderWhoeverReads) {
  Table table;
  std::array<int, 8> stay{};
  for (std::uint64_t key = 1; key <= stay.size(); ++key) put(table, key, stay[key - 1]);
  std::atomic<bool> stop{false};
  std::atomic<int> lost{0};
  std::atomic<int> rounds{0};
  std::thread reader([&] {
    while (!stop.load(std::memory_order_relaxed)) {
      for (std::uint64_t key = 1; key <= stay.size(); ++key) lost += table.find(key) != &stay[key - 1] ? 1 : 0;
      ++rounds;
    }
  });
  for (int i = 0; i < 3000 || rounds.load() < 100; ++i) {
    std::array<std::unique_ptr<int>, 12> come;
    for (std::uint64_t k = 0; k < come.size(); ++k) {
      come[k] = std::make_unique<int>(0);
      put(table, 100 + k, *come[k]);
    }
    for (std::uint64_t k = 0; k < come.size(); ++k)
      EXPECT_EQ(table.remove(100 + (5 * k + 7) % 12), come[(5 * k + 7) % 12].get());
  }
  stop = true;
  reader.join();
  EXPECT_EQ(lost.load(), 0);
}

}  // namespace
}  // namespace odds::ode
