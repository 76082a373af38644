// Makes inputs from seeds: bytes, numbers, words, lines and counts changed; cut, spliced, packed. Repeatable.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "odds/math/random.hpp"
#include "seeds.hpp"

namespace odds::fuzz {

struct Input {
  std::string content;
  std::string format;  ///< of the seed that it came from; "" if from none
};

/// The n-th input of a seed number does not depend on the others: input(n) can be made again alone.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed);
  [[nodiscard]] Input input(std::uint64_t n);

 private:
  std::uint64_t below(std::uint64_t bound) { return bound == 0 ? 0 : random_.below(bound); }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  void mutate(std::string& text);
  void change_bytes(std::string& text);
  void change_range(std::string& text);
  void change_number(std::string& text);
  void change_binary_number(std::string& text);
  void change_lines(std::string& text);
  void insert_word(std::string& text);
  void splice(std::string& text);
  std::string from_nothing();
  std::string packed(const std::string& text);

  std::vector<Seed> seeds_;
  std::uint64_t seed_;
  math::Random random_{0};
};

}  // namespace odds::fuzz
