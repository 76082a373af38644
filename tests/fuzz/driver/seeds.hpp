// Small valid files of every format and variant, from which fuzzing starts.
#pragma once

#include <string>
#include <vector>

namespace odds::fuzz {

struct Seed {
  std::string format;  ///< obj, stl, ply or off
  std::string title;
  std::string content;
};

std::vector<Seed> seeds();

}  // namespace odds::fuzz
