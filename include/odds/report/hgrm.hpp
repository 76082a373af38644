// HdrHistogram's percentile text format (.hgrm): what the web plotter, gnuplot and spreadsheets read.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/report/histogram.hpp"

namespace odds::report {

/// Writes the percentile table. Values are divided by `unit`: with 1000, nanoseconds come out as microseconds.
/// `steps_per_half` lines are written for each halving of the distance to 100 %, as HdrHistogram does.
void write_hgrm(std::ostream& out, const Histogram& histogram, double unit = 1000.0, int steps_per_half = 5);

struct HgrmRow {
  double value = 0.0;             ///< in the file's unit
  double fraction = 0.0;          ///< percentile / 100, in [0, 1]
  std::uint64_t total_count = 0;  ///< counts up to here
};

/// A percentile table that was read.
struct HgrmTable {
  std::vector<HgrmRow> rows;  ///< fractions, values and counts never fall
  double mean = 0.0;
  double standard_deviation = 0.0;
  double max = 0.0;
  std::uint64_t count = 0;
};

/// Reads such a table; `name` is for messages. Rejects what is not one: errors name the line. Any bytes are safe.
[[nodiscard]] Result<HgrmTable> read_hgrm(std::istream& in, const std::string& name);

}  // namespace odds::report
