// odds_bench_frames: 200 pairs of meshes in a frame of 500 us: by importance, and with equal shares.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
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

}  // namespace

int main(int argc, char** argv) {
  int pairs = 200;
  int frames = 2000;
  double frame_us = 500.0;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    if (name == "--pairs") pairs = std::atoi(argv[i + 1]);
    if (name == "--frames") frames = std::atoi(argv[i + 1]);
    if (name == "--frame-us") frame_us = std::atof(argv[i + 1]);
  }
  if (argc % 2 == 0 || pairs < 1 || frames < 1 || !(frame_us > 0.0)) {
    std::fprintf(stderr, "usage: odds_bench_frames [--pairs N] [--frames N] [--frame-us T]\n");
    return 2;
  }
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
