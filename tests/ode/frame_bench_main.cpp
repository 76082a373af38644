// odds_bench_frames: 200 pairs of meshes in a frame of 500 us: by importance, and with equal shares.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include "odds/realtime/thread_setup.hpp"
#include "ode/frame_crowd.hpp"

namespace {

using odds::test::Crowd;
using odds::test::CrowdPair;

struct Figures {
  int frames = 0;
  int overran = 0;
  double most_over_us = 0.0;
  double gross_p50_us = 0.0;
  double gross_p99_us = 0.0;
  int longest_wait = 0;
  double touching_right = 0.0;  // share of the pairs that touch
  double apart_right = 0.0;
  double served = 0.0;
};

Figures measure(Crowd& crowd, dSpaceID space, int sharing, double frame_us, int frames) {
  const oddsFrameBudgetID budget = oddsFrameBudgetCreate(4096);
  oddsFrameBudgetSetTime(budget, frame_us);
  oddsFrameBudgetSetSharing(budget, sharing);
  Figures figures;
  std::vector<double> gross_us;
  double touching = 0.0;
  double apart = 0.0;
  for (int frame = -10; frame < frames; ++frame) {  // the first ones only learn
    crowd.run(space, budget);
    if (frame < 0) continue;
    oddsFrameSummary summary;
    oddsFrameBudgetGetSummary(budget, &summary);
    ++figures.frames;
    gross_us.push_back(summary.gross_us);
    if (summary.overshoot_us > 0.0) ++figures.overran;
    figures.most_over_us = std::max(figures.most_over_us, summary.overshoot_us);
    figures.longest_wait = std::max(figures.longest_wait, summary.waiting_longest);
    figures.served += static_cast<double>(summary.served) / summary.pairs;
    for (const CrowdPair& pair : crowd.pairs()) {
      const bool right = (pair.contacts > 0) == pair.touches;
      (pair.touches ? touching : apart) += 1.0;
      if (right) (pair.touches ? figures.touching_right : figures.apart_right) += 1.0;
    }
  }
  oddsFrameBudgetDestroy(budget);
  std::sort(gross_us.begin(), gross_us.end());
  figures.gross_p50_us = gross_us[gross_us.size() / 2];
  figures.gross_p99_us = gross_us[gross_us.size() * 99 / 100];
  figures.touching_right /= std::max(1.0, touching);
  figures.apart_right /= std::max(1.0, apart);
  figures.served /= figures.frames;
  return figures;
}

// The whole of `text`, or false.
template <class Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

struct Options {
  int pairs = 200;
  int frames = 2000;
  double frame_us = 500.0;
};

// False for an option that there is not, or a value that is none of its own.
bool read_options(std::span<char*> words, Options& options) {
  if (words.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const std::string_view name = words[i];
    const std::string_view value = words[i + 1];
    const bool known = (name == "--pairs" && read_number(value, options.pairs)) ||
                       (name == "--frames" && read_number(value, options.frames)) ||
                       (name == "--frame-us" && read_number(value, options.frame_us));
    if (!known) return false;
  }
  return options.pairs >= 1 && options.frames >= 1 && options.frame_us > 0.0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(std::span(argv, static_cast<std::size_t>(argc)).subspan(1), options)) {
    std::fprintf(stderr, "usage: odds_bench_frames [--pairs N] [--frames N] [--frame-us T]\n");
    return 2;
  }
  const auto [pairs, frames, frame_us] = options;
  if (oddsInitODE(0) == 0) return 1;
  odds::realtime::ThreadRequest request;
  request.fifo_priority = 50;  // where the system grants it, stalls are fewer
  (void)odds::realtime::set_up_this_thread(request);
  const dSpaceID space = dHashSpaceCreate(nullptr);
  {
    Crowd crowd(space, pairs, 512);
    const auto touching =
        std::count_if(crowd.pairs().begin(), crowd.pairs().end(), [](const CrowdPair& p) { return p.touches; });
    std::printf("%d pairs of torus knots (%d touch), %.0f us a frame, %d frames each way\n", pairs,
                static_cast<int>(touching), frame_us, frames);
    std::printf("%-14s %8s %8s %10s %12s %8s %12s %10s %8s\n", "shares", "p50 us", "p99 us", "overran", "most over us",
                "served", "touch right", "apart", "waited");
    for (int round = 0; round < 3; ++round) {
      for (const int sharing : {ODDS_SHARE_BY_IMPORTANCE, ODDS_SHARE_EQUALLY}) {
        const Figures f = measure(crowd, space, sharing, frame_us, frames);
        std::printf("%-14s %8.1f %8.1f %4d/%-5d %12.2f %7.1f%% %11.1f%% %9.1f%% %8d\n",
                    sharing == ODDS_SHARE_EQUALLY ? "equal" : "importance", f.gross_p50_us, f.gross_p99_us, f.overran,
                    f.frames, f.most_over_us, 100.0 * f.served, 100.0 * f.touching_right, 100.0 * f.apart_right,
                    f.longest_wait);
      }
    }
  }
  dSpaceDestroy(space);
  oddsCloseODE();
  return 0;
}
