// Times of several engines on the same poses, and what is told about them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "benchmark/peer.hpp"

namespace odds::benchmark {

/// What one engine did with one list of poses.
struct PeerRun {
  std::string engine;
  std::vector<double> microseconds;   ///< by pose
  std::vector<std::size_t> contacts;  ///< by pose; 0 or 1 where only the verdict was asked for
  std::size_t wrong = 0;              ///< verdicts that differ from FCL's where that does not hang on 1e-9 of the size
};

/// The q-quantile by nearest rank; 0 for no times.
[[nodiscard]] double quantile(std::vector<double> values, double q);

/// One line an engine; ratios are to the first engine.
void print_runs(const std::vector<PeerRun>& runs);
void print_footprints(const std::vector<std::unique_ptr<Peer>>& peers);

/// Ratios to the first engine, gathered over meshes, by class and engine.
class Ratios {
 public:
  void add(const std::string& pose_class, const std::vector<PeerRun>& runs);
  /// Geometric means and least ratios of medians and of 99th percentiles.
  void print() const;

 private:
  struct Series {
    std::vector<double> p50;
    std::vector<double> p99;
    std::size_t wrong = 0;
  };
  std::vector<std::string> classes_;
  std::vector<std::string> engines_;
  std::map<std::pair<std::string, std::string>, Series> series_;
};

}  // namespace odds::benchmark
