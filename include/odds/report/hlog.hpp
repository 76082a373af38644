// HdrHistogram's interval log (.hlog) and its V2 compressed encoding: what HistogramLogAnalyzer and its kin read.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/report/histogram.hpp"

namespace odds::report {

/// The V2 compressed encoding, base64. All counters, the range, nothing else.
[[nodiscard]] std::string encode_histogram(const Histogram& histogram);
/// Reads such a text. Any bytes are safe: sizes are checked before memory is taken, at most 64 MiB.
[[nodiscard]] Result<Histogram> decode_histogram(std::string_view base64);

/// One line of the log.
struct HlogInterval {
  std::string tag;       ///< series, no commas or white space; empty for the untagged one
  double start_s = 0.0;  ///< since the log's start
  double length_s = 0.0;
  Histogram histogram;  ///< nanoseconds
};

struct Hlog {
  double start_epoch_s = 0.0;  ///< seconds since 1970
  std::vector<HlogInterval> intervals;
};

/// Writes format version 1.3; the column Interval_Max is in milliseconds, as its readers expect of nanoseconds.
void write_hlog(std::ostream& out, const Hlog& log);
/// The same piece by piece, for logs whose histograms would fill the memory: the head, then every interval.
void write_hlog_head(std::ostream& out, double start_epoch_s);
void write_hlog_interval(std::ostream& out, const HlogInterval& interval);

/// Reads a log; `name` is for messages. Errors name the line. Any bytes are safe.
[[nodiscard]] Result<Hlog> read_hlog(std::istream& in, const std::string& name);

}  // namespace odds::report
